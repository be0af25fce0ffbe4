#include "manual.hpp"

#include "treacle/core/version.hpp"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

namespace treacle {
namespace {

OptionText textOf(const CLI::Option& option) {
  OptionText text;
  if (!option.get_snames().empty()) text.shortName = "-" + option.get_snames().front();
  if (!option.get_lnames().empty()) text.longName = "--" + option.get_lnames().front();
  text.about = option.get_description();
  if (option.get_expected_max() == 0) return text;
  const bool isPositional = text.shortName.empty() && text.longName.empty();
  const std::string type = option.get_type_name();
  text.value = isPositional ? option.get_name(true) : type;
  if (type.find('|') == type.npos) return text;
  std::size_t from = 0;
  for (std::size_t bar; (bar = type.find('|', from)) != type.npos; from = bar + 1)
    text.words.push_back(type.substr(from, bar - from));
  text.words.push_back(type.substr(from));
  return text;
}

CommandText textOf(const CLI::App& command, bool isWhole) {
  CommandText text{isWhole ? "" : command.get_name(), command.get_description(), {}};
  for (const CLI::Option* option : command.get_options()) text.options.push_back(textOf(*option));
  return text;
}

/// As text of troff.
std::string roff(const std::string& text) {
  std::string safe = text.starts_with('.') || text.starts_with('\'') ? "\\&" : "";
  for (const char c : text)
    if (c == '\\')
      safe += "\\e";
    else if (c == '-')
      safe += "\\-";
    else
      safe += c;
  return safe;
}

std::string manOptions(const CommandText& command) {
  std::string text;
  for (const OptionText& o : command.options) {
    std::string names;
    for (const std::string& name : {o.shortName, o.longName})
      if (!name.empty()) names += fmt::format("{}\\fB{}\\fR", names.empty() ? "" : ", ", roff(name));
    const bool isPositional = names.empty();
    if (!o.value.empty()) names += fmt::format("{}\\fI{}\\fR", isPositional ? "" : " ", roff(o.value));
    text += fmt::format(".TP\n{}\n{}\n", names, roff(o.about));
  }
  return text;
}

std::string synopsis(const CommandText& command) {
  std::string text = fmt::format(".B treacle {}\n", roff(command.name));
  for (const OptionText& o : command.options)
    if (o.shortName.empty() && o.longName.empty()) text += fmt::format("\\fI{}\\fR ", roff(o.value));
  return text + "[\\fIoptions\\fR]\n.br\n";
}

}  // namespace

std::vector<CommandText> commandTexts(const CLI::App& app) {
  std::vector<CommandText> all{textOf(app, true)};
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
    all.push_back(textOf(*command, false));
  return all;
}

std::string manPage(const CLI::App& app) {
  const std::vector<CommandText> all = commandTexts(app);
  std::string page =
      fmt::format(".TH TREACLE 1 \"\" \"treacle {}\" \"User Commands\"\n.SH NAME\ntreacle \\- {}\n.SH SYNOPSIS\n",
                  buildInfo().version, roff(all[0].about));
  for (std::size_t k = 1; k < all.size(); ++k) page += synopsis(all[k]);
  page += ".SH OPTIONS\n" + manOptions(all[0]) + ".SH COMMANDS\n";
  for (std::size_t k = 1; k < all.size(); ++k)
    page += fmt::format(".SS treacle {}\n{}.\n{}", roff(all[k].name), roff(all[k].about), manOptions(all[k]));
  return page +
         ".SH EXIT STATUS\n.TP\n0\nDone; the runs that were compared agree.\n.TP\n1\nThe runs that were compared "
         "differ.\n.TP\n2\nBad input: nothing was run.\n.TP\n3\nThe run failed, and says why.\n"
         ".SH ENVIRONMENT\n.TP\n\\fBOMP_NUM_THREADS\\fR\nNumber of threads, where \\-\\-threads does not say.\n"
         ".TP\n\\fBCUDA_VISIBLE_DEVICES\\fR\nWhich GPUs there are for the program.\n";
}

}  // namespace treacle
