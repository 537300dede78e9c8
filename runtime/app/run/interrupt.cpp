#include "run/interrupt.h"

#include <ctime>

namespace galactic {

Interrupt::Interrupt() {
  sigemptyset(&signals_);
  sigaddset(&signals_, SIGINT);
  sigaddset(&signals_, SIGTERM);
  pthread_sigmask(SIG_BLOCK, &signals_, &before_);
}

Interrupt::~Interrupt() { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }

bool Interrupt::came() const {
  const timespec now{};
  return sigtimedwait(&signals_, nullptr, &now) > 0;
}

}  // namespace galactic
