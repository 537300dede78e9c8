#pragma once
#include <gtest/gtest.h>

#include <cstring>
#include <functional>
#include <vector>

#include "galactic/pack.h"
#include "support/aligned_bytes.h"
#include "support/sanitized.h"

namespace galactic::test {

inline constexpr std::size_t kBitsPerByte = 8;

inline void flipBit(AlignedBytes& bytes, std::size_t bit) {
  bytes.bytes()[bit / kBitsPerByte] ^= std::byte{1} << (bit % kBitsPerByte);
}

/// Each length below the whole is refused, whatever the trust.
inline void expectEachTruncationRefused(const AlignedBytes& whole) {
  for (std::size_t length = 0; length < whole.size(); ++length) {
    const AlignedBytes part(whole.bytes().first(length));
    for (const Trust trust : {Trust::kVerify, Trust::kTrusted}) {
      const Result<PackFile> pack = PackFile::view(part.bytes(), "short.pack", trust);
      ASSERT_FALSE(pack.has_value()) << length;
      ASSERT_EQ(pack.error().code, ErrorCode::kInvalidInput) << length;
      ASSERT_EQ(pack.error().where, "short.pack") << length;
    }
  }
}

inline void expectBytesTooManyRefused(const AlignedBytes& whole) {
  for (std::size_t extra = 1; extra <= 64; ++extra) {
    std::vector<std::byte> longer(whole.bytes().begin(), whole.bytes().end());
    longer.resize(longer.size() + extra);
    const AlignedBytes bytes(longer);
    EXPECT_FALSE(PackFile::view(bytes.bytes(), "long.pack").has_value()) << extra;
  }
}

inline void expectEachBitFlipRefused(AlignedBytes bytes) {
  for (std::size_t bit = 0; bit < bytes.size() * kBitsPerByte; ++bit) {
    flipBit(bytes, bit);
    const Result<PackFile> pack = PackFile::view(bytes.bytes(), "flipped.pack");
    ASSERT_FALSE(pack.has_value()) << bit;
    ASSERT_FALSE(pack.error().message.empty());
    flipBit(bytes, bit);
  }
  EXPECT_TRUE(PackFile::view(bytes.bytes(), "whole.pack").has_value());
}

/// Flips each bit of the payload and makes the hash fit again: what opens goes through `use`. Where
/// a sanitizer watches, each third bit, which is each of a byte's in turn. Some, not all, have to
/// be refused: codes may change and stay well-formed, offsets may not.
inline void expectFlipsWithARightHashRefusedOrUsable(
    AlignedBytes bytes, PackKind kind, const std::function<void(const PackFile&)>& use) {
  const auto payload = bytes.bytes().subspan(sizeof(PackHeader));
  constexpr std::size_t kStep = kIsSanitized ? 3 : 1;
  std::size_t refused = 0;
  std::size_t tried = 0;
  for (std::size_t bit = 0; bit < payload.size() * kBitsPerByte; bit += kStep) {
    ++tried;
    const std::size_t in_file = sizeof(PackHeader) * kBitsPerByte + bit;
    flipBit(bytes, in_file);
    const PackHeader header = makePackHeader(kind, payload);
    std::memcpy(bytes.bytes().data(), &header, sizeof(header));
    const Result<PackFile> pack = PackFile::view(bytes.bytes(), "flipped.pack");
    if (pack) {
      use(*pack);
      if (testing::Test::HasFatalFailure()) FAIL() << "after flipping bit " << bit;
    } else {
      ++refused;
      ASSERT_NE(pack.error().message, "");
    }
    flipBit(bytes, in_file);
  }
  EXPECT_GT(refused, tried / 10);
  EXPECT_LT(refused, tried * 9 / 10);
}

}  // namespace galactic::test
