#pragma once
#include <pybind11/pybind11.h>

#include <stdexcept>
#include <string>
#include <utility>

namespace galactic::python {

/// Restricts an object to one thread at a time: calls release the interpreter's lock, so a second
/// thread could enter. The flag is read and written only under the lock.
class Confinement {
 public:
  explicit Confinement(const char* what) : what_(what) {}

  /// The use of the object by one call, from before it releases the lock until it has taken it
  /// again.
  class Use {
   public:
    explicit Use(bool& in_use) : in_use_(&in_use) { in_use = true; }
    ~Use() {
      if (in_use_ != nullptr) *in_use_ = false;
    }
    Use(Use&& other) noexcept : in_use_(std::exchange(other.in_use_, nullptr)) {}
    Use(const Use&) = delete;
    Use& operator=(const Use&) = delete;
    Use& operator=(Use&&) = delete;

   private:
    bool* in_use_;
  };

  /// Begins a use. Raises RuntimeError while another thread uses the object.
  [[nodiscard]] Use enter() {
    if (in_use_) {
      throw std::runtime_error(std::string("another thread is using this galactic.") + what_ +
                               "; give each thread its own");
    }
    return Use(in_use_);
  }

 private:
  const char* what_;
  bool in_use_ = false;
};

}  // namespace galactic::python
