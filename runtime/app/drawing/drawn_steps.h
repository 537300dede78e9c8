#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "drawing/picture_output.h"
#include "drawing/rendering.h"
#include "galactic/batch_simulator.h"
#include "galactic/error.h"
#include "run/run_report.h"

namespace galactic {

/// Steps a batch and draws it: the state before a step is drawn while the step is being simulated.
class DrawnSteps {
 public:
  /// One in this many steps is simulated and drawn one after the other, to measure each alone. The
  /// first step of a run, which touches memory for the first time, is not measured.
  static constexpr std::uint64_t kMeasureEvery = 16;

  /// For the run of `options`. Fails with the errors of PictureOutput::open and Rendering::create.
  [[nodiscard]] static Result<DrawnSteps> create(const World& world,
                                                 const BatchSimulator& simulator,
                                                 const RunOptions& options);

  /// Draws the state and simulates a step; `report.steps` steps have been done so far. Adds to the
  /// times in the report.
  [[nodiscard]] Result<void> step(BatchSimulator& simulator, std::span<const float> actions,
                                  RunReport& report);

  /// Call it after the last step, even if the run ended early: draws the last state and completes
  /// all pictures.
  [[nodiscard]] Result<void> finish(const BatchSimulator& simulator, const RunReport& report);

  [[nodiscard]] const BatchRenderer& renderer() const { return rendering_.renderer(); }
  [[nodiscard]] const std::vector<std::string>& semanticNames() const {
    return rendering_.semanticNames();
  }

 private:
  DrawnSteps(Rendering rendering, PictureOutput output);

  Rendering rendering_;
  PictureOutput output_;
};

}  // namespace galactic
