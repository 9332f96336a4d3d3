#include "tests/cli/program.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace ramcdb::test {
namespace {

struct Pipe {
  int read_end = -1, write_end = -1;
  Pipe() {
    std::array<int, 2> ends = {};
    if (pipe2(ends.data(), O_CLOEXEC) != 0) throw std::runtime_error("pipe2 failed");
    read_end = ends[0];
    write_end = ends[1];
  }
};

[[noreturn]] void become_program(const Arguments& arguments, int out, int err) {
  std::vector<char*> argv;
  std::string program = RAMCDB_PROGRAM;
  Arguments copies = arguments;
  argv.push_back(program.data());
  for (std::string& argument : copies) argv.push_back(argument.data());
  argv.push_back(nullptr);
  dup2(open("/dev/null", O_RDONLY | O_CLOEXEC), STDIN_FILENO);
  dup2(out, STDOUT_FILENO);
  dup2(err, STDERR_FILENO);
  execv(program.c_str(), argv.data());
  _exit(127);
}

/// Appends what is there; false at the end of the pipe.
bool read_some(int pipe, std::string& text) {
  std::array<char, 4096> block = {};
  const ssize_t n = read(pipe, block.data(), block.size());
  if (n > 0) text.append(block.data(), static_cast<std::size_t>(n));
  return n > 0;
}

}  // namespace

RunningProgram::RunningProgram(const Arguments& arguments) {
  const Pipe out, err;
  pid_ = fork();
  if (pid_ < 0) throw std::runtime_error("fork failed");
  if (pid_ == 0) become_program(arguments, out.write_end, err.write_end);
  close(out.write_end);
  close(err.write_end);
  out_ = out.read_end;
  err_ = err.read_end;
}

void RunningProgram::send(int signal) const { kill(pid_, signal); }

Outcome RunningProgram::wait() {
  Outcome outcome;
  std::array<pollfd, 2> pipes = {pollfd{out_, POLLIN, 0}, pollfd{err_, POLLIN, 0}};
  while (pipes[0].fd >= 0 || pipes[1].fd >= 0) {
    if (poll(pipes.data(), pipes.size(), -1) < 0) continue;
    if (pipes[0].revents != 0 && !read_some(out_, outcome.out)) pipes[0].fd = -1;
    if (pipes[1].revents != 0 && !read_some(err_, outcome.err)) pipes[1].fd = -1;
  }
  close(out_);
  close(err_);
  int status = 0;
  waitpid(pid_, &status, 0);
  outcome.code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return outcome;
}

Outcome run_ramcdb(const Arguments& arguments) { return RunningProgram(arguments).wait(); }

std::string read_text(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

void write_text(const std::string& file, const std::string& text) { std::ofstream(file, std::ios::binary) << text; }

}  // namespace ramcdb::test
