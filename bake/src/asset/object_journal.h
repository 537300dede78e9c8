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

/// An object that was baked, and what was read for it.
struct FinishedObject {
  /// By their names below the folder of its mesh.
  ReadFiles read;
  double import_seconds = 0;
  BakedObject object;
};

/// What the bake of a set of objects that was interrupted has done. Thread-safe.
class ObjectJournal {
 public:
  /// `journal`: null where nothing is kept. `radii`: how many there are.
  ObjectJournal(std::unique_ptr<Journal> journal, std::size_t radii);

  /// None where it was not baked, or not of what its files hold now.
  [[nodiscard]] std::optional<FinishedObject> recall(const ObjectInput& input) const;
  /// Fails with kIo.
  [[nodiscard]] Result<void> add(const ObjectInput& input, const FinishedObject& finished) const;
  /// After the pack is written.
  void remove() const;

 private:
  std::unique_ptr<Journal> journal_;
  std::size_t radii_;
  /// By the names of the objects.
  std::map<std::string, std::string_view, std::less<>> records_;
};

}  // namespace galactic::bake
