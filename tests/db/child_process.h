#pragma once

#include <gtest/gtest.h>

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <exception>
#include <functional>
#include <utility>

namespace ramcdb::db::test {

/// Runs a function in a forked child, which ends with status 0 when it returned and no expectation failed in it.
/// A child that nobody waited for is killed with its test.
class ChildProcess {
 public:
  explicit ChildProcess(const std::function<void()>& run) {
    std::fflush(nullptr);
    pid_ = ::fork();
    if (pid_ != 0) return;
    try {
      run();
    } catch (const std::exception& e) {
      ADD_FAILURE() << "in a child process: " << e.what();
    }
    std::fflush(nullptr);
    ::_exit(::testing::Test::HasFailure() ? 1 : 0);
  }
  ChildProcess(ChildProcess&& other) noexcept : pid_(std::exchange(other.pid_, -1)) {}
  ChildProcess& operator=(ChildProcess&& other) noexcept {
    std::swap(pid_, other.pid_);
    return *this;
  }
  ~ChildProcess() {
    if (pid_ <= 0) return;
    ::kill(pid_, SIGKILL);
    (void)wait();
  }

  [[nodiscard]] pid_t pid() const { return pid_; }

  /// Its status as of waitpid(): 0 when all went well, W_EXITCODE(status, signal) otherwise.
  [[nodiscard]] int wait() {
    int status = -1;
    ::waitpid(std::exchange(pid_, -1), &status, 0);
    return status;
  }

 private:
  pid_t pid_ = -1;
};

}  // namespace ramcdb::db::test
