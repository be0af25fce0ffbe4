#include "manual.hpp"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

namespace treacle {
namespace {

bool isPositional(const OptionText& o) { return o.shortName.empty() && o.longName.empty(); }

std::vector<std::string> namesOf(const OptionText& o) {
  std::vector<std::string> names;
  for (const std::string& name : {o.shortName, o.longName})
    if (!name.empty()) names.push_back(name);
  return names;
}

/// Names of commands, and options of the program itself.
std::string firstWords(const std::vector<CommandText>& all) {
  std::vector<std::string> words;
  for (const CommandText& command : all)
    if (!command.name.empty()) words.push_back(command.name);
  for (const OptionText& o : all[0].options)
    for (const std::string& name : namesOf(o)) words.push_back(name);
  return fmt::format("{}", fmt::join(words, " "));
}

/// A text in single quotes of a shell.
std::string quoted(const std::string& text) {
  std::string safe;
  for (const char c : text) safe += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return '\'' + safe + '\'';
}

/// zsh has its own meaning for some characters in the description of an option.
std::string withoutBrackets(const std::string& text) {
  std::string safe;
  for (const char c : text) safe += c == '[' || c == ']' || c == ':' ? std::string("\\") + c : std::string(1, c);
  return safe;
}

std::string bashScript(const std::vector<CommandText>& all) {
  std::string values, options;
  for (const CommandText& command : all) {
    if (command.name.empty()) continue;
    std::vector<std::string> names;
    for (const OptionText& o : command.options) {
      if (isPositional(o) && !o.words.empty())
        for (const std::string& word : o.words) names.push_back(word);
      for (const std::string& name : namesOf(o)) {
        names.push_back(name);
        if (!o.words.empty())
          values += fmt::format("    '{} {}') words='{}' ;;\n", command.name, name, fmt::join(o.words, " "));
      }
    }
    options += fmt::format("      {}) words='{}' ;;\n", command.name, fmt::join(names, " "));
  }
  return fmt::format(R"(# Completion of treacle for bash: source <(treacle completion bash)
_treacle() {{
  local current=${{COMP_WORDS[COMP_CWORD]}} before=${{COMP_WORDS[COMP_CWORD - 1]}} command=${{COMP_WORDS[1]}} words=
  if [ "$COMP_CWORD" -eq 1 ]; then
    mapfile -t COMPREPLY < <(compgen -W '{}' -- "$current")
    return
  fi
  case "$command $before" in
{}    *) case "$command" in
{}    esac ;;
  esac
  mapfile -t COMPREPLY < <(compgen -W "$words" -- "$current"; [[ $current == -* ]] || compgen -f -- "$current")
}}
complete -o filenames -F _treacle treacle
)",
                     firstWords(all), values, options);
}

std::string zshScript(const std::vector<CommandText>& all) {
  std::string commands, cases;
  for (const CommandText& command : all) {
    if (command.name.empty()) continue;
    commands += fmt::format("    {}\n", quoted(command.name + ':' + command.about));
    cases += fmt::format("    {})\n      _arguments -S", command.name);
    for (const OptionText& o : command.options) {
      const std::string action = o.words.empty() ? "_files" : fmt::format("({})", fmt::join(o.words, " "));
      const std::string value =
          o.value.empty() ? "" : fmt::format(":{}:{}", o.words.empty() ? o.value : "word", action);
      for (const std::string& name : namesOf(o))
        cases += " \\\n        " + quoted(fmt::format("*{}[{}]{}", name, withoutBrackets(o.about), value));
      if (isPositional(o)) cases += fmt::format(" \\\n        ':{}:{}'", o.value, action);
    }
    cases += "\n      ;;\n";
  }
  return fmt::format(R"(#compdef treacle
# Completion of treacle for zsh: source <(treacle completion zsh), or this file as _treacle in a folder of $fpath
_treacle() {{
  local -a commands=(
{}  )
  if (( CURRENT == 2 )); then
    _describe command commands
    return
  fi
  local command=$words[2]
  shift words
  (( CURRENT-- ))
  case $command in
{}  esac
}}
if [ "$funcstack[1]" = _treacle ]; then _treacle "$@"; else compdef _treacle treacle; fi
)",
                     commands, cases);
}

std::string fishScript(const std::vector<CommandText>& all) {
  std::string script = "# Completion of treacle for fish: treacle completion fish | source\n";
  for (const CommandText& command : all) {
    const std::string condition =
        command.name.empty() ? "__fish_use_subcommand" : "__fish_seen_subcommand_from " + command.name;
    if (!command.name.empty())
      script += fmt::format("complete -c treacle -f -n __fish_use_subcommand -a {} -d {}\n", command.name,
                            quoted(command.about));
    for (const OptionText& o : command.options) {
      script += fmt::format("complete -c treacle -n '{}'", condition);
      if (!o.shortName.empty()) script += " -s " + o.shortName.substr(1);
      if (!o.longName.empty()) script += " -l " + o.longName.substr(2);
      if (!o.words.empty())
        script += fmt::format(" -xa '{}'", fmt::join(o.words, " "));
      else if (!o.value.empty() && !isPositional(o))
        script += " -r";
      script += fmt::format(" -d {}\n", quoted(o.about));
    }
  }
  return script;
}

}  // namespace

std::string completionScript(const CLI::App& app, Shell shell) {
  const std::vector<CommandText> all = commandTexts(app);
  switch (shell) {
    case Shell::Bash:
      return bashScript(all);
    case Shell::Zsh:
      return zshScript(all);
    case Shell::Fish:
      break;
  }
  return fishScript(all);
}

}  // namespace treacle
