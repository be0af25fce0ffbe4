#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace CLI {
class App;
}

namespace treacle {

/// What is made of the commands and options of the program, so that it cannot know other ones.

/// The page for man(1), in the macros of man(7).
std::string manPage(const CLI::App& app);

enum class Shell { Bash, Zsh, Fish };

/// A script that has a shell complete commands, options, their words and the names of files.
std::string completionScript(const CLI::App& app, Shell shell);

/// An option as it is given on the command line, or a positional one.
struct OptionText {
  std::string shortName, longName;  // "-o", "--output"; both empty: positional
  std::string about, value;         // "", of flags; else "DIR" or the words that it takes
  std::vector<std::string> words;   // that it takes, where there are such
};

/// A command, or the program itself with an empty name.
struct CommandText {
  std::string name, about;
  std::vector<OptionText> options;
};

/// The program first.
std::vector<CommandText> commandTexts(const CLI::App& app);

}  // namespace treacle
