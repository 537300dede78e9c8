#include "dynamics/report/side_by_side.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "command_line/options.h"
#include "drawing/contact_sheet.h"
#include "drawing/rendering.h"
#include "dynamics/report/names.h"
#include "pictures/png_file.h"
#include "run/tracked_run.h"
#include "support/atomic_file.h"
#include "support/try.h"
#include "view/json_writer.h"
#include "view/page.h"
#include "view/run_track.h"

namespace galactic::dynamics {
namespace {

/// Pixels of a picture.
constexpr std::uint32_t kWidth = 480;
constexpr std::uint32_t kHeight = 360;

/// What one world looks like while an episode is played in it.
class Onlooker {
 public:
  /// `rendering`: null without pictures. `steps`: after which ones there is a picture.
  Onlooker(const World& world, Rendering* rendering, std::vector<std::uint32_t> steps)
      : world_(world), rendering_(rendering), steps_(std::move(steps)) {}

  void look(const BatchSimulator& simulator, std::span<const float> actions) {
    if (actions.empty()) {
      track_.emplace(world_, simulator, 1);
      return;
    }
    track_->add(simulator, actions);
    const auto step = static_cast<std::uint32_t>(track_->steps()) - 1;
    if (rendering_ == nullptr) return;
    // Where the episode ends before, its end is shown.
    if (std::ranges::find(steps_, step) != steps_.end() || simulator.dones()[0] != 0) {
      rendering_->update(simulator);
      rendering_->begin();
      rendering_->end();
      last_.emplace(tileOf(rendering_->frames().front()));
      pictures_.insert_or_assign(step, *last_);
    }
  }

  [[nodiscard]] const RunTrack& track() const { return *track_; }
  /// After this step or, where there was none, the last one.
  [[nodiscard]] const pictures::Image& picture(std::uint32_t step) const {
    const auto found = pictures_.find(step);
    return found == pictures_.end() ? *last_ : found->second;
  }

 private:
  const World& world_;
  Rendering* rendering_;
  std::vector<std::uint32_t> steps_;
  std::optional<RunTrack> track_;
  std::map<std::uint32_t, pictures::Image> pictures_;
  std::optional<pictures::Image> last_;
};

/// Lets a lane follow what the simulation did.
void replayHere(const EpisodeTrace& trace, EpisodeLane& lane, Onlooker& onlooker) {
  lane.begin(trace.episode, ArmDrive::kKinematic);
  onlooker.look(lane.simulator(), {});
  for (std::size_t n = 0; n < trace.steps.size(); ++n) {
    const TracedStep& step = trace.steps[n];
    const std::vector<Pose> objects = objectsAfter(trace, n);
    lane.follow(step.actions, {.world_from_root = step.world_from_root,
                               .joint_positions = step.positions,
                               .objects = objects,
                               .held = step.held ? static_cast<std::int32_t>(*step.held) : -1,
                               .was_hindered = step.was_refused});
    onlooker.look(lane.simulator(), step.actions);
  }
}

Result<Rendering> makeRendering(const World& world, const EpisodeLane& lane) {
  RunOptions options;
  options.simulation = lane.simulator().options();
  options.drawing.images = "rgb";
  options.drawing.width = kWidth;
  options.drawing.height = kHeight;
  options.drawing.camera = "follow";
  return Rendering::create(world, lane.simulator(), options, 1);
}

std::string factsOf(const ReportSubject& subject) {
  JsonWriter json;
  json.begin('{');
  json.text("policy", subject.isReplay() ? "replay" : subject.policy);
  if (subject.isReplay()) json.text("recording", subject.recording);
  json.text("arm", nameOf(subject.options.arm));
  json.text("base", nameOf(subject.options.base));
  json.end('}');
  return json.take();
}

/// All episodes of the worst moments, played again.
class SideBySide {
 public:
  SideBySide(const SideBySideParts& parts, const SideBySideFiles& files)
      : parts_(parts), files_(files) {}

  Result<void> play() {
    if (!files_.pictures.empty()) {
      ASSIGN_OR_RETURN(here_, makeRendering(parts_.worlds.world, parts_.here));
      ASSIGN_OR_RETURN(there_, makeRendering(parts_.worlds.world, parts_.there));
    }
    std::map<std::size_t, std::vector<std::size_t>> moments;
    for (std::size_t n = 0; n < worst().size(); ++n) moments[worst()[n].comparison].push_back(n);
    cells_.resize(2 * worst().size());
    for (const auto& [comparison, of] : moments) RETURN_IF_ERROR(play(comparison, of));
    return {};
  }

  [[nodiscard]] Result<void> writePictures() const {
    std::vector<SheetCell> cells;
    for (const std::optional<SheetCell>& cell : cells_) cells.push_back(*cell);
    constexpr std::size_t kColumns = 2;
    return pictures::writePng(files_.pictures, contactSheet(cells, kColumns));
  }

  [[nodiscard]] Result<void> writePage(const ReportSubject& subject) const {
    ASSIGN_OR_RETURN(const auto assets, pageAssetsOf(*track_));
    ASSIGN_OR_RETURN(const auto page, viewPage(assets,
                                               {.track = &*track_,
                                                .facts = factsOf(subject),
                                                .names = names_,
                                                .twins = twins_,
                                                .moments = page_moments_},
                                               {.title = files_.view.stem().string(),
                                                .generator = "galactic-dynamics"}));
    return writeFileAtomically(files_.view, {std::as_bytes(std::span(page))});
  }

 private:
  [[nodiscard]] const std::vector<Moment>& worst() const { return parts_.comparisons.worst; }

  Result<void> play(std::size_t comparison, const std::vector<std::size_t>& moments) {
    std::vector<std::uint32_t> steps;
    for (const std::size_t n : moments) steps.push_back(worst()[n].step);
    const World& world = parts_.worlds.world;
    Onlooker here(world, here_ ? &*here_ : nullptr, steps);
    Onlooker there(world, there_ ? &*there_ : nullptr, steps);
    ASSIGN_OR_RETURN(const auto trace, parts_.trace_of(comparison));
    replayHere(trace, parts_.here, here);
    RETURN_IF_ERROR(
        compareEpisode(trace, parts_.there, parts_.worlds, parts_.is_closed,
                       [&](const BatchSimulator& simulator, std::span<const float> actions) {
                         there.look(simulator, actions);
                       }));
    keep(here.track(), there.track(), trace.episode);
    for (const std::size_t n : moments) keep(n, here, there);
    return {};
  }

  void keep(const RunTrack& here, const RunTrack& there, std::uint32_t episode) {
    if (track_) {
      track_->append(here);
    } else {
      track_.emplace(here);
    }
    track_->append(there);
    const auto first = static_cast<std::uint32_t>(names_.size());
    names_.push_back(fmt::format("Episode {}: simulation", episode));
    names_.push_back(fmt::format("Episode {}: dynamics", episode));
    twins_.insert(twins_.end(), {first + 1, first});
  }

  void keep(std::size_t n, const Onlooker& here, const Onlooker& there) {
    const Moment& moment = worst()[n];
    const EpisodeComparison& episode = parts_.comparisons.episodes[moment.comparison];
    const std::size_t env = names_.size() - 1;
    const auto last = static_cast<std::uint32_t>(there.track().steps());
    page_moments_.push_back({.env = env,
                             .frame = std::min(moment.step + 1, last),
                             .text = describe(moment, episode, parts_.worlds.world)});
    if (!here_) return;
    cells_[2 * n] = {here.picture(moment.step), fmt::format("{}. episode {}, step {}", n + 1,
                                                            episode.episode, moment.step + 1)};
    cells_[2 * n + 1] = {there.picture(moment.step),
                         fmt::format("dynamics: {}, {:.3f} m", nameOf(moment.kind), moment.meters)};
  }

  const SideBySideParts& parts_;
  const SideBySideFiles& files_;
  std::optional<Rendering> here_;
  std::optional<Rendering> there_;
  std::optional<RunTrack> track_;
  std::vector<std::string> names_;
  std::vector<std::uint32_t> twins_;
  std::vector<PageMoment> page_moments_;
  /// Two for each moment.
  std::vector<std::optional<SheetCell>> cells_;
};

}  // namespace

Result<void> writeSideBySide(const SideBySideParts& parts, const ReportSubject& subject,
                             const SideBySideFiles& files) {
  if (parts.comparisons.worst.empty() || (files.view.empty() && files.pictures.empty())) return {};
  SideBySide both(parts, files);
  RETURN_IF_ERROR(both.play());
  if (!files.pictures.empty()) RETURN_IF_ERROR(both.writePictures());
  return files.view.empty() ? Result<void>() : both.writePage(subject);
}

}  // namespace galactic::dynamics
