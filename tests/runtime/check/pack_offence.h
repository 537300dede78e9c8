#pragma once
#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <vector>

#include "galactic/pack.h"
#include "support/aligned_bytes.h"

namespace galactic::test {

/// A change of a valid pack and what opening must say then; "; bake the pack again" follows.
template <class Fields>
struct PackOffence {
  std::string where;
  std::string message;
  std::function<void(Fields&)> change;
};

/// Opens `valid` after each change on its own, through the `buildPack` of its fields.
template <class Fields>
void expectRefused(const Fields& valid, const std::vector<PackOffence<Fields>>& offences) {
  for (const PackOffence<Fields>& offence : offences) {
    SCOPED_TRACE(offence.where + ": " + offence.message);
    Fields fields = valid;
    offence.change(fields);
    const AlignedBytes bytes = buildPack(fields);
    const Result<PackFile> pack = PackFile::view(bytes.bytes(), "made.pack");
    if (pack) {
      ADD_FAILURE() << "was accepted";
      continue;
    }
    EXPECT_EQ(pack.error().code, ErrorCode::kInvalidInput);
    EXPECT_EQ(pack.error().where, "made.pack: " + offence.where);
    EXPECT_EQ(pack.error().message, offence.message + "; bake the pack again");
  }
}

}  // namespace galactic::test
