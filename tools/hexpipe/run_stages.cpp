#include "tools/hexpipe/run_stages.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <utility>

#include "common/run/deadline.hpp"
#include "common/run/error.hpp"
#include "common/run/messages.hpp"
#include "common/run/progress_record.hpp"

namespace hexpipe::front_door {
namespace {

constexpr int exit_usage = 2, cannot_start = 127;

// A file descriptor that is closed when it is no longer needed.
class Descriptor {
 public:
  explicit Descriptor(int number = -1) : number_(number) {}
  ~Descriptor() { close(); }
  Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    close();
    number_ = std::exchange(other.number_, -1);
    return *this;
  }
  int get() const { return number_; }
  bool is_open() const { return number_ >= 0; }
  void close() {
    if (number_ >= 0) ::close(number_);
    number_ = -1;
  }

 private:
  int number_;
};

int checked(int result, const char* what) {
  if (result < 0) throw DataError(fmt::format("cannot {}: {}", what, std::strerror(errno)));
  return result;
}

// Both ends close in a process that is started, unless they are given to it.
std::pair<Descriptor, Descriptor> make_pipe() {
  std::array<int, 2> ends{};
  checked(pipe2(ends.data(), O_CLOEXEC), "make a pipe");
  return {Descriptor(ends[0]), Descriptor(ends[1])};
}

// The tools are beside this one; otherwise the PATH has to know them.
std::string path_of(const std::string& tool) {
  std::error_code error;
  const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe", error);
  const std::filesystem::path beside = self.parent_path() / tool;
  return !error && access(beside.c_str(), X_OK) == 0 ? beside.string() : tool;
}

struct Process {
  std::string tool;
  pid_t pid = -1;
  bool is_done = false;
  int exit_code = 0;
  Descriptor messages;         // its standard error
  std::string line, withheld;  // of that: an unfinished line, and the last line
  Descriptor statistics;       // a file in memory
  Descriptor progress;         // another one
};

std::vector<char*> arguments(std::vector<std::string>& words) {
  std::vector<char*> result;
  for (std::string& word : words) result.push_back(word.data());
  result.push_back(nullptr);
  return result;
}

// Runs in the new process: it may only make system calls.
[[noreturn]] void become(const std::string& path, std::vector<char*>& words, int in, int out, int messages,
                         pid_t parent, pid_t group) {
  setpgid(0, group);
  prctl(PR_SET_PDEATHSIG, SIGTERM);
  if (getppid() != parent) _exit(cannot_start);
  for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGPIPE}) signal(number, SIG_DFL);
  if (in >= 0) dup2(in, STDIN_FILENO);
  if (out >= 0) dup2(out, STDOUT_FILENO);
  dup2(messages, STDERR_FILENO);
  execvp(path.c_str(), words.data());
  const char* reason = errno == ENOENT ? "it is neither beside hexpipe nor on the PATH" : std::strerror(errno);
  dprintf(STDERR_FILENO, "cannot start: %s\n", reason);
  _exit(cannot_start);
}

class PipeRun {
 public:
  explicit PipeRun(const RunOptions& options)
      : options_(options), shows_progress_(!options.quiet && has_terminal_line()) {}
  ~PipeRun() {
    if (shows_progress_) clear_terminal_line();
    if (group_ > 0 && running_ > 0) kill(-group_, SIGKILL);
    for (Process& process : processes_)
      if (process.pid > 0 && !process.is_done) waitpid(process.pid, nullptr, 0);
    for (const std::string& file : kept_) unlink((file + ".part").c_str());
  }
  PipeRun(const PipeRun&) = delete;
  PipeRun& operator=(const PipeRun&) = delete;

  void start(const std::vector<Command>& commands);
  void wait();
  std::vector<StageOutcome> outcomes();

 private:
  void start(const Command& command, Descriptor in, Descriptor out);
  void start_tee(const std::string& file, Descriptor in, Descriptor out);
  Process& launch(std::string tool, const std::string& path, std::vector<std::string> words, Descriptor in,
                  Descriptor out);
  void read_messages(Process& process);
  void reap();
  void hand_on_signal();
  void show_progress();
  void judge() const;

  RunOptions options_;
  const bool shows_progress_;
  Stopwatch watch_;
  double next_progress_ = 0;
  std::vector<Process> processes_;
  pid_t group_ = 0;  // of all processes started, apart from ours: a terminal's Ctrl-C reaches only us
  std::size_t running_ = 0;
  bool told_to_stop_ = false;
  std::vector<std::string> kept_;  // files that get their names when all is well
};

Process& PipeRun::launch(std::string tool, const std::string& path, std::vector<std::string> words, Descriptor in,
                         Descriptor out) {
  auto [read_end, write_end] = make_pipe();
  Descriptor progress(shows_progress_ && tool != "tee" ? checked(memfd_create("progress", 0), "show progress") : -1);
  if (progress.is_open())
    setenv(progress_record_variable, std::to_string(progress.get()).c_str(), 1);
  else
    unsetenv(progress_record_variable);
  std::vector<char*> list = arguments(words);
  const pid_t parent = getpid();
  const pid_t child = checked(fork(), "start a process");
  if (child == 0) become(path, list, in.get(), out.get(), write_end.get(), parent, group_);
  setpgid(child, group_);
  if (group_ == 0) group_ = child;
  ++running_;
  Process process;
  process.tool = std::move(tool);
  process.pid = child;
  process.messages = std::move(read_end);
  process.progress = std::move(progress);
  processes_.push_back(std::move(process));
  return processes_.back();
}

void PipeRun::start(const Command& command, Descriptor in, Descriptor out) {
  Descriptor statistics(checked(memfd_create(command.tool.c_str(), 0), "keep statistics in memory"));
  std::vector<std::string> words{command.tool};
  words.insert(words.end(), command.words.begin(), command.words.end());
  const bool has_own = std::ranges::find(command.words, "--stats") != command.words.end();
  if (!has_own) words.insert(words.end(), {"--stats", fmt::format("/dev/fd/{}", statistics.get())});
  if (options_.quiet) words.emplace_back("-q");
  if (options_.verbose) words.emplace_back("-v");
  Process& process = launch(command.tool, path_of(command.tool), std::move(words), std::move(in), std::move(out));
  if (!has_own) process.statistics = std::move(statistics);
}

// A kept file gets its name only when all of it is there.
void PipeRun::start_tee(const std::string& file, Descriptor in, Descriptor out) {
  kept_.push_back(file);
  launch("tee", "tee", {"tee", file + ".part"}, std::move(in), std::move(out));
}

void PipeRun::start(const std::vector<Command>& commands) {
  group_ = 0;
  Descriptor in;
  for (std::size_t i = 0; i < commands.size(); ++i) {
    const bool last = i + 1 == commands.size();
    auto [next_in, out] = last ? std::pair<Descriptor, Descriptor>() : make_pipe();
    if (commands[i].kept_in) {
      auto [tee_in, to_tee] = make_pipe();
      start(commands[i], std::move(in), std::move(to_tee));
      start_tee(*commands[i].kept_in, std::move(tee_in), std::move(out));
    } else {
      start(commands[i], std::move(in), std::move(out));
    }
    in = std::move(next_in);
  }
}

// Lines are passed on as they come, except the last one: if the tool fails, that line says why, and only the first tool
// of a pipe that fails is heard.
void PipeRun::read_messages(Process& process) {
  std::array<char, 4096> buffer;
  const ssize_t count = read(process.messages.get(), buffer.data(), buffer.size());
  if (count <= 0) {
    if (count == 0 || errno != EINTR) process.messages.close();
    return;
  }
  process.line.append(buffer.data(), static_cast<std::size_t>(count));
  for (std::size_t end; (end = process.line.find('\n')) != std::string::npos;) {
    if (!process.withheld.empty()) print_lines(process.withheld);
    process.withheld = process.line.substr(0, end + 1);
    process.line.erase(0, end + 1);
  }
}

void PipeRun::reap() {
  for (Process& process : processes_) {
    if (process.is_done || process.messages.is_open()) continue;
    int status = 0;
    const pid_t ended = waitpid(process.pid, &status, WNOHANG);
    if (ended != process.pid) continue;
    process.is_done = true;
    --running_;
    process.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    process.withheld += process.line;
    if (process.exit_code == 0 && !process.withheld.empty()) print_lines(process.withheld);
  }
}

void PipeRun::hand_on_signal() {
  if (!stop_requested() || told_to_stop_) return;
  told_to_stop_ = true;
  if (!options_.quiet) print_message("hexpipe", "stopping; assembling what there is (again: give up)");
  if (group_ > 0) kill(-group_, SIGINT);
}

// Tools behind the first one that is at work wait for it, except where it writes and the next one reads.
void PipeRun::show_progress() {
  constexpr double seconds_between = 0.1;
  if (!shows_progress_ || watch_.seconds() < next_progress_) return;
  next_progress_ = watch_.seconds() + seconds_between;
  std::size_t number = 0, tools = 0;
  std::string shown;
  bool is_known = false;
  for (const Process& process : processes_) {
    if (process.tool == "tee") continue;
    ++tools;
    if (process.is_done || is_known) continue;
    const std::string progress = read_progress_record(process.progress.get());
    is_known = !progress.empty();
    if (!is_known && !shown.empty()) continue;
    shown = is_known ? fmt::format("{}: {}", process.tool, progress) : process.tool;
    number = tools;
  }
  if (shown.empty()) return;
  const std::string place = tools > 1 ? fmt::format("{}/{} ", number, tools) : "";
  show_terminal_line(fmt::format("hexpipe: {:.0f} s, {}{}", watch_.seconds(), place, shown));
}

void PipeRun::wait() {
  while (running_ > 0) {
    std::vector<pollfd> polled;
    std::vector<Process*> whose;
    for (Process& process : processes_) {
      if (!process.messages.is_open()) continue;
      polled.push_back({process.messages.get(), POLLIN, 0});
      whose.push_back(&process);
    }
    constexpr int milliseconds = 50;
    if (poll(polled.data(), polled.size(), milliseconds) > 0)
      for (std::size_t i = 0; i < polled.size(); ++i)
        if (polled[i].revents != 0) read_messages(*whose[i]);
    reap();
    hand_on_signal();
    show_progress();
  }
  judge();
}

// A tool that writes into a pipe whose reader is gone fails, too, but has nothing to say of its own: the tool that
// broke the pipe comes after it. It ends by SIGPIPE if that tool is ours.
void PipeRun::judge() const {
  const auto says_why = [](const Process& process) {
    return process.exit_code != 0 && process.exit_code != 128 + SIGPIPE &&
           process.withheld.find("Broken pipe") == std::string::npos;
  };
  auto failed = std::ranges::find_if(processes_, says_why);
  if (failed == processes_.end())
    failed = std::ranges::find_if(processes_, [](const Process& process) { return process.exit_code != 0; });
  if (failed == processes_.end()) return;
  std::string text = failed->withheld;
  while (!text.empty() && text.back() == '\n') text.pop_back();
  if (text.empty())
    text = failed->exit_code > 128 ? fmt::format("{}: ended by signal {}", failed->tool, failed->exit_code - 128)
                                   : fmt::format("{}: failed with exit code {}", failed->tool, failed->exit_code);
  if (failed->exit_code == cannot_start) text = fmt::format("{}: {}", failed->tool, text);
  if (failed->exit_code == exit_usage) throw UsageError(text);
  throw DataError(text);
}

std::vector<StageOutcome> PipeRun::outcomes() {
  for (const std::string& file : kept_) std::filesystem::rename(file + ".part", file);
  kept_.clear();
  std::vector<StageOutcome> result;
  for (const Process& process : processes_) {
    if (process.tool == "tee") continue;
    StageOutcome outcome{process.tool, nullptr};
    if (process.statistics.is_open()) {
      std::string text;
      std::array<char, 65536> buffer;
      ssize_t count = 0;
      while ((count = pread(process.statistics.get(), buffer.data(), buffer.size(), static_cast<off_t>(text.size()))) >
             0)
        text.append(buffer.data(), static_cast<std::size_t>(count));
      outcome.statistics = nlohmann::ordered_json::parse(text, nullptr, false);
      if (outcome.statistics.is_discarded()) outcome.statistics = nullptr;
    }
    result.push_back(std::move(outcome));
  }
  return result;
}

std::vector<StageOutcome> run_together(const std::vector<Command>& commands, const RunOptions& options) {
  PipeRun pipe(options);
  pipe.start(commands);
  pipe.wait();
  return pipe.outcomes();
}

}  // namespace

std::vector<StageOutcome> run(const Plan& plan, const RunOptions& options) {
  std::vector<StageOutcome> outcomes = run_together(plan.pipe, options);
  for (const Command& command : plan.behind) {
    std::vector<StageOutcome> more = run_together({command}, options);
    std::ranges::move(more, std::back_inserter(outcomes));
  }
  return outcomes;
}

}  // namespace hexpipe::front_door
