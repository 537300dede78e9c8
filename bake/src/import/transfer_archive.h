#pragma once
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

#include "galactic/error.h"

namespace galactic::bake {

/// Receives consecutive pieces of a transfer.
using TransferSink = std::function<void(std::span<const std::byte>)>;

/// Types whose values can be copied as bytes. Excludes views and pointers, since what they point to
/// is elsewhere, and optional values, where no byte is sure to say whether there is a value.
template <class T>
concept Plain = std::is_trivially_copyable_v<T> && !std::is_pointer_v<T> &&
                !std::is_same_v<T, std::string_view> && !requires(const T& value) {
  value.has_value();
};

template <class T>
inline constexpr bool kIsOptional = false;
template <class T>
inline constexpr bool kIsOptional<std::optional<T>> = true;

/// For transferFields: one list of fields per type serves both directions.
template <class T, class Base>
concept Is = std::is_same_v<std::remove_const_t<T>, Base>;

template <class Archive>
void transferFields(Archive& archive, Is<Error> auto& error) {
  archive(error.code, error.where, error.message);
}

/// Writes values as bytes for another process, or a later run, of this same program. A type that is
/// neither plain nor a list nor optional needs a function template `transferFields(archive, value)`
/// in galactic::bake, which calls the archive with its fields; the archive is a writer or a reader.
class TransferWriter {
 public:
  explicit TransferWriter(const TransferSink& sink) : sink_(sink) {}

  template <class... Fields>
  void operator()(const Fields&... fields) {
    (put(fields), ...);
  }

 private:
  template <class T>
  void put(const T& value) {
    if constexpr (Plain<T>) {
      sink_(std::as_bytes(std::span(&value, 1)));
    } else if constexpr (requires { value.data(); }) {
      putList(value);
    } else if constexpr (kIsOptional<T>) {
      put(value.has_value());
      if (value) put(*value);
    } else {
      transferFields(*this, value);
    }
  }

  void putList(const auto& list) {
    using Element = std::remove_cvref_t<decltype(list[0])>;
    put(std::uint64_t{list.size()});
    if constexpr (Plain<Element>) {
      sink_(std::as_bytes(std::span(list.data(), list.size())));
    } else {
      for (const Element& element : list) put(element);
    }
  }

  const TransferSink& sink_;
};

/// The bytes that a TransferWriter writes for `fields`.
template <class... Fields>
[[nodiscard]] std::string bytesOf(const Fields&... fields) {
  std::string bytes;
  const TransferSink sink = [&bytes](std::span<const std::byte> more) {
    bytes.append(reinterpret_cast<const char*>(more.data()), more.size());
  };
  TransferWriter{sink}(fields...);
  return bytes;
}

/// Reads what a TransferWriter wrote; never reads beyond the given bytes.
class TransferReader {
 public:
  explicit TransferReader(std::span<const std::byte> bytes) : left_(bytes) {}

  [[nodiscard]] bool good() const { return good_; }
  [[nodiscard]] bool atEnd() const { return left_.empty(); }

  template <class... Fields>
  void operator()(Fields&... fields) {
    (get(fields), ...);
  }

 private:
  template <class T>
  void get(T& value) {
    if constexpr (std::is_same_v<T, bool>) {
      std::uint8_t byte = 0;
      get(byte);
      value = byte != 0;
    } else if constexpr (Plain<T>) {
      take(&value, sizeof(T));
    } else if constexpr (requires { value.data(); }) {
      getList(value);
    } else if constexpr (kIsOptional<T>) {
      bool is_there = false;
      get(is_there);
      value.reset();
      if (is_there) get(value.emplace());
    } else {
      transferFields(*this, value);
    }
  }

  void getList(auto& list) {
    using Element = std::remove_cvref_t<decltype(list[0])>;
    std::uint64_t size = 0;
    get(size);
    if constexpr (Plain<Element>) {
      if (!good_ || size > left_.size() / sizeof(Element)) return stop();
      list.resize(static_cast<std::size_t>(size));
      take(list.data(), list.size() * sizeof(Element));
    } else {
      // Each element takes at least one byte, so a wrong size ends with the input.
      for (std::uint64_t i = 0; i < size && good_; ++i) get(list.emplace_back());
    }
  }

  void take(void* to, std::size_t bytes) {
    if (!good_ || bytes > left_.size()) return stop();
    if (bytes == 0) return;
    std::memcpy(to, left_.data(), bytes);
    left_ = left_.subspan(bytes);
  }

  void stop() {
    good_ = false;
    left_ = {};
  }

  std::span<const std::byte> left_;
  bool good_ = true;
};

}  // namespace galactic::bake
