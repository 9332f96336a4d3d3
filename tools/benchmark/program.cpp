#include "tools/benchmark/program.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <exception>
#include <fstream>
#include <optional>
#include <stop_token>
#include <thread>

#include "ramcdb/error.h"
#include "tools/benchmark/timing.h"

namespace ramcdb::benchmark {
namespace {

std::uint64_t anonymous_bytes(pid_t process) {
  std::ifstream status(fmt::format("/proc/{}/status", process));
  for (std::string line; std::getline(status, line);)
    if (line.starts_with("RssAnon:")) return 1024 * std::stoull(line.substr(8));
  return 0;
}

/// Looks at a process until it is told to stop.
class AnonymousMemoryWatch {
 public:
  explicit AnonymousMemoryWatch(pid_t process)
      : watch_([this, process](const std::stop_token& done) {
          while (!done.stop_requested()) {
            peak_ = std::max(peak_, anonymous_bytes(process));
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
          }
        }) {}
  std::uint64_t stop() {
    watch_.request_stop();
    watch_.join();
    return peak_;
  }

 private:
  std::uint64_t peak_ = 0;
  std::jthread watch_;
};

std::string read_all(int from) {
  std::string text;
  std::array<char, 4096> block{};
  for (ssize_t n = 0; (n = ::read(from, block.data(), block.size())) > 0;)
    text.append(block.data(), static_cast<std::size_t>(n));
  ::close(from);
  return text;
}

/// Starts a program whose standard output comes out of `output`.
pid_t spawn(std::vector<std::string>& command, int& output) {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) throw Error(Errc::storage, "no pipe for a program");
  std::vector<char*> arguments;
  for (std::string& word : command) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
  pid_t child = 0;
  const int failure = posix_spawn(&child, arguments[0], &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  ::close(ends[1]);
  output = ends[0];
  if (failure) throw Error(Errc::invalid_argument, "the program cannot be started", command.front());
  return child;
}

}  // namespace

int run_guarded(int (*run)(int, char**), int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::exception& e) {
    fmt::print(stderr, "{}\n", e.what());
    return 1;
  }
}

ProgramUse run_program(std::vector<std::string> command) {
  ProgramUse use;
  const double cpu_before = cpu_seconds(RUSAGE_CHILDREN);
  int status = 0, output = -1;
  std::optional<AnonymousMemoryWatch> watch;
  use.seconds = seconds([&] {
    const pid_t child = spawn(command, output);
    watch.emplace(child);
    use.output = read_all(output);
    ::waitpid(child, &status, 0);
  });
  use.peak_anonymous = watch->stop();
  if (status != 0)
    throw Error(Errc::invalid_argument, "the program failed", fmt::format("{}", fmt::join(command, " ")));
  use.cpu_seconds = cpu_seconds(RUSAGE_CHILDREN) - cpu_before;
  return use;
}

}  // namespace ramcdb::benchmark
