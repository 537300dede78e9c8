#pragma once
#include <csignal>

namespace galactic {

/// While it lives, Ctrl-C and SIGTERM do not end the program but wait to be asked for. Make it
/// before threads start, which inherit this. Destroyed, the next signal ends the program as usual.
class Interrupt {
 public:
  Interrupt();
  ~Interrupt();
  Interrupt(const Interrupt&) = delete;
  Interrupt& operator=(const Interrupt&) = delete;
  Interrupt(Interrupt&&) = delete;
  Interrupt& operator=(Interrupt&&) = delete;

  /// Whether a signal has come since it was last asked for.
  [[nodiscard]] bool came() const;

 private:
  sigset_t signals_{};
  sigset_t before_{};
};

}  // namespace galactic
