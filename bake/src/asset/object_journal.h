#pragma once
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "galactic/bake/assets.h"
#include "galactic/bake/object_baker.h"
#include "galactic/bake/read_files.h"
#include "support/files/journal.h"

namespace galactic::bake {

/// A baked object and the files that were read for it.
struct FinishedObject {
  /// Names relative to the folder of the mesh.
  ReadFiles read;
  double import_seconds = 0;
  BakedObject object;
};

/// The objects that an interrupted bake of an object set has finished. Thread-safe.
class ObjectJournal {
 public:
  /// `journal`: null if nothing is kept. `radii`: number of radii.
  ObjectJournal(std::unique_ptr<Journal> journal, std::size_t radii);

  /// The finished object; none if it was not baked, or if its files have changed since.
  [[nodiscard]] std::optional<FinishedObject> recall(const ObjectInput& input) const;
  /// Fails with kIo.
  [[nodiscard]] Result<void> add(const ObjectInput& input, const FinishedObject& finished) const;
  /// Call it after the pack has been written.
  void remove() const;

 private:
  std::unique_ptr<Journal> journal_;
  std::size_t radii_;
  /// By the names of the objects.
  std::map<std::string, std::string_view, std::less<>> records_;
};

}  // namespace galactic::bake
