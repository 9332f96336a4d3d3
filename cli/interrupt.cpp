#include "cli/interrupt.h"

#include <signal.h>

#include <csignal>

namespace ramcdb::cli {
namespace {

volatile std::sig_atomic_t asked_to_stop = 0;

}  // namespace

void catch_interrupts() {
  struct sigaction action = {};
  action.sa_handler = [](int) { asked_to_stop = 1; };
  // SA_RESETHAND: the second Ctrl-C finds the default action. SA_RESTART: reads in progress do not fail.
  action.sa_flags = static_cast<int>(static_cast<unsigned>(SA_RESETHAND) | static_cast<unsigned>(SA_RESTART));
  sigaction(SIGINT, &action, nullptr);
}

bool interrupted() noexcept { return asked_to_stop != 0; }

}  // namespace ramcdb::cli
