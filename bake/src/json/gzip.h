#pragma once
#include <cstddef>
#include <span>
#include <string>

#include "galactic/error.h"

namespace galactic::bake {

/// Whether the bytes begin like a gzip file.
[[nodiscard]] bool isGzip(std::span<const std::byte> bytes);

/// Decompresses the gzip file `bytes`, which may hold several consecutive members (RFC 1952). Fails
/// with kInvalidInput, naming `where`, if the file is truncated or damaged, has trailing bytes, or
/// holds more than `max_bytes`. This is checked in a first pass, before memory is allocated for the
/// content.
[[nodiscard]] Result<std::string> gunzip(std::span<const std::byte> bytes, const std::string& where,
                                         std::size_t max_bytes);

}  // namespace galactic::bake
