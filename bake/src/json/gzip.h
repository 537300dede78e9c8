#pragma once
#include <cstddef>
#include <span>
#include <string>

#include "galactic/error.h"

namespace galactic::bake {

/// Whether the bytes begin as a file of gzip does.
[[nodiscard]] bool isGzip(std::span<const std::byte> bytes);

/// What the gzip file `bytes` holds: one member or several, one after the other (RFC 1952). Fails
/// with kInvalidInput, naming `where`, on a file that ends early, that is damaged, that has
/// something else behind it, and on one that holds more than `max_bytes`: it is read through once
/// before memory is taken for what it holds.
[[nodiscard]] Result<std::string> gunzip(std::span<const std::byte> bytes, const std::string& where,
                                         std::size_t max_bytes);

}  // namespace galactic::bake
