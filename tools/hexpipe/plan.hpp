#pragma once
// Which tools run with which words, and the shell commands that do the same.

#include <optional>
#include <string>
#include <vector>

#include "tools/hexpipe/options.hpp"

namespace hexpipe::front_door {

// A process: the tool's name and its words.
struct Command {
  std::string tool;
  std::vector<std::string> words;
  // The file that keeps what it writes to the next stage, if asked for.
  std::optional<std::string> kept_in;
};

struct Plan {
  std::optional<std::string> folder;  // made first
  std::vector<Command> pipe;          // each reads what the one before it writes
  std::vector<Command> behind;        // each starts when all is written
};

// Throws UsageError when options contradict each other.
Plan plan_of(const PipeOptions& options);

// A line for each part of the plan, for a POSIX shell.
std::string as_shell(const Plan& plan);

// The words of a text as a POSIX shell takes them apart: blanks, quotes and backslashes, nothing else is special.
// Throws UsageError where a quote does not end; `option` names the text in the message.
std::vector<std::string> shell_words(const std::string& text, const std::string& option);

}  // namespace hexpipe::front_door
