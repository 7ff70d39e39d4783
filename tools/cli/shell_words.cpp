#include "tools/cli/shell_words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <string_view>
#include <vector>

namespace kinebus {
namespace {

std::string replaced(std::string text, std::string_view what, std::string_view by) {
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + by.size()))
    text.replace(at, what.size(), by);
  return text;
}

/// A word between '...' of any shell.
std::string quoted(const std::string& text) {
  return "'" + replaced(text, "'", R"('\'')") + "'";
}

std::vector<const CLI::App*> commands_of(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App*) { return true; });
}

struct Command {
  std::string path;  ///< as it is typed: "users key"
  const CLI::App* app;
};

/// All of them, each before those within it.
std::vector<Command> all_commands_of(const CLI::App& app, const std::string& path = {}) {
  std::vector<Command> all;
  for (const CLI::App* command : commands_of(app)) {
    all.push_back({path.empty() ? command->get_name() : path + " " + command->get_name(), command});
    for (Command& within : all_commands_of(*command, all.back().path)) all.push_back(std::move(within));
  }
  return all;
}

std::vector<const CLI::Option*> options_of(const CLI::App& app) {
  std::vector<const CLI::Option*> options = app.get_options();
  std::erase_if(options, [](const CLI::Option* o) { return o->get_lnames().empty(); });
  return options;
}

bool takes_value(const CLI::Option& option) {
  return option.get_items_expected_max() > 0;
}

std::string names_of(const CLI::App& app) {
  std::string names;
  for (const CLI::App* command : commands_of(app)) names += command->get_name() + " ";
  for (const CLI::Option* option : options_of(app)) names += "--" + option->get_lnames()[0] + " ";
  if (!names.empty()) names.pop_back();
  return names;
}

std::string roff(std::string text) {
  text = replaced(replaced(std::move(text), "\\", "\\e"), "-", "\\-");
  return text.starts_with('.') || text.starts_with('\'') ? "\\&" + text : text;
}

std::string upper(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::toupper(c); });
  return text;
}

std::string roff_options(const CLI::App& app, bool with_help) {
  std::string text;
  for (const CLI::Option* option : app.get_options()) {
    if (option == app.get_help_ptr() && !with_help) continue;
    const bool positional = option->get_lnames().empty() && option->get_snames().empty();
    std::string name = positional ? upper(option->get_name()) : "";
    for (const std::string& s : option->get_snames()) name += (name.empty() ? "-" : ", -") + s;
    for (const std::string& l : option->get_lnames()) name += (name.empty() ? "--" : ", --") + l;
    text += fmt::format(".TP\n\\fB{}\\fR{}\n{}\n", roff(name),
                        !positional && takes_value(*option) ? " \\fIVALUE\\fR" : "",
                        roff(option->get_description().empty() ? "(needed)" : option->get_description()));
  }
  return text;
}

}  // namespace

std::string bash_completion(const CLI::App& app) {
  const std::string& name = app.get_name();
  std::string valued, cases, paths;
  for (const CLI::Option* option : options_of(app))
    if (takes_value(*option)) valued += (valued.empty() ? "--" : "|--") + option->get_lnames()[0];
  for (const Command& command : all_commands_of(app)) {
    paths += (paths.empty() ? "" : "|") + quoted(command.path);
    cases +=
        fmt::format("    {}) words={} ;;\n", quoted(command.path),
                    quoted(names_of(*command.app) + " " + names_of(app).substr(names_of(app).find("--"))));
  }
  return fmt::format(
      "# bash completion for {0}\n"
      "_{0}() {{\n"
      "  local current=${{COMP_WORDS[COMP_CWORD]}} command= longer= words= i\n"
      "  for ((i = 1; i < COMP_CWORD; ++i)); do\n"
      "    case ${{COMP_WORDS[i]}} in\n"
      "    {1}) ((++i)) ;;\n"
      "    -*) ;;\n"
      "    *) longer=${{command:+$command }}${{COMP_WORDS[i]}}\n"
      "      case $longer in\n"
      "      {4}) command=$longer ;;\n"
      "      *) command=${{command:-$longer}}; break ;;\n"
      "      esac ;;\n"
      "    esac\n"
      "  done\n"
      "  case $command in\n"
      "    '') words={2} ;;\n"
      "{3}"
      "  esac\n"
      "  mapfile -t COMPREPLY < <(compgen -W \"$words\" -- \"$current\")\n"
      "}}\n"
      "complete -o default -F _{0} {0}\n",
      name, valued, quoted(names_of(app)), cases, paths);
}

std::string zsh_completion(const CLI::App& app) {
  const auto spec = [](const CLI::Option& option) {
    std::string help = replaced(replaced(option.get_description(), "[", "("), "]", ")");
    return quoted(fmt::format("--{}[{}]{}", option.get_lnames()[0], replaced(help, ":", "\\:"),
                              takes_value(option) ? ":value:_files" : ""));
  };
  std::string commands, cases, common, paths;
  for (const CLI::Option* option : options_of(app)) common += " " + spec(*option);
  for (const CLI::App* command : commands_of(app)) {
    commands +=
        "    " + quoted(command->get_name() + ":" + replaced(command->get_description(), ":", "\\:")) + "\n";
  }
  for (const Command& command : all_commands_of(app)) {
    std::string arguments, within;
    for (const CLI::Option* option : options_of(*command.app)) arguments += " " + spec(*option);
    for (const CLI::App* next : commands_of(*command.app))
      within += (within.empty() ? "" : " ") + next->get_name();
    const std::string rest = within.empty() ? "'*:file:_files'" : quoted("1:command:(" + within + ")");
    cases += fmt::format("      {}) _arguments{} {} ;;\n", quoted(command.path), arguments, rest);
    paths += (paths.empty() ? "" : "|") + quoted(command.path);
  }
  return fmt::format(
      "#compdef {0}\n"
      "_{0}() {{\n"
      "  local state line\n"
      "  local -a commands=(\n{1}  )\n"
      "  _arguments -C{2} '1:command:->command' '*::argument:->argument'\n"
      "  case $state in\n"
      "  command) _describe command commands ;;\n"
      "  argument)\n"
      "    local known=$words[1]\n"
      "    while (( CURRENT > 2 )); do\n"
      "      case \"$known $words[2]\" in\n"
      "      {4}) known+=\" $words[2]\"; shift words; (( CURRENT-- )) ;;\n"
      "      *) break ;;\n"
      "      esac\n"
      "    done\n"
      "    case $known in\n{3}    esac ;;\n"
      "  esac\n"
      "}}\n"
      "_{0} \"$@\"\n",
      app.get_name(), commands, common, cases, paths);
}

std::string fish_completion(const CLI::App& app) {
  const std::string& name = app.get_name();
  std::string text = fmt::format("# fish completion for {}\n", name);
  const auto add = [&](const CLI::Option& option, const std::string& where) {
    text += fmt::format("complete -c {}{} -l {}{} -d {}\n", name, where, option.get_lnames()[0],
                        takes_value(option) ? " -r" : "", quoted(option.get_description()));
  };
  for (const CLI::Option* option : options_of(app)) add(*option, "");
  for (const CLI::App* command : commands_of(app)) {
    text += fmt::format("complete -c {} -n __fish_use_subcommand -a {} -d {}\n", name, command->get_name(),
                        quoted(command->get_description()));
  }
  for (const Command& command : all_commands_of(app)) {
    std::string seen;
    for (const std::string& word : CLI::detail::split(command.path, ' '))
      seen += (seen.empty() ? "" : "; and ") + ("__fish_seen_subcommand_from " + word);
    for (const CLI::App* next : commands_of(*command.app))
      text += fmt::format("complete -c {} -n '{}' -a {} -d {}\n", name, seen, next->get_name(),
                          quoted(next->get_description()));
    for (const CLI::Option* option : options_of(*command.app))
      if (option->get_lnames()[0] != "help") add(*option, fmt::format(" -n '{}'", seen));
  }
  return text;
}

std::string man_page(const CLI::App& app, const std::string& version) {
  const std::string& name = app.get_name();
  const std::string& about = app.get_description();
  std::string text = fmt::format(
      ".TH {} 1 \"\" \"{} {}\"\n.SH NAME\n{} \\- {}\n.SH SYNOPSIS\n.B {}\n[OPTIONS] COMMAND [ARGUMENTS]\n",
      upper(name), name, version, name, roff(about.substr(about.find(": ") + 2)), name);
  text += ".SH OPTIONS\nThey may stand before or behind the command.\n" + roff_options(app, true) +
          ".SH COMMANDS\n";
  for (const Command& command : all_commands_of(app))
    text += fmt::format(".SS {}\n{}.\n{}", roff(command.path), roff(command.app->get_description()),
                        roff_options(*command.app, false));
  text +=
      ".SH EXIT STATUS\n0: done. 1: refused, or the machine did not come to where it should. 2: wrong "
      "arguments.\n";
  if (app.get_option_no_throw("--socket") != nullptr)
    text +=
        ".SH ENVIRONMENT\n.TP\n.B KINEBUS_SOCKET\nThe daemon's local socket, when \\fB\\-\\-socket\\fR is "
        "not "
        "given.\n";
  return text;
}

void add_shell_words(CLI::App& app, const std::string& version) {
  auto* completion =
      app.add_subcommand("completion", "Print what bash, zsh or fish need to complete this command");
  auto shell = std::make_shared<std::string>();
  completion->add_option("shell", *shell, "bash, zsh or fish")
      ->required()
      ->check(CLI::IsMember({"bash", "zsh", "fish"}));
  completion->callback([&app, shell] {
    fmt::print("{}", *shell == "bash"  ? bash_completion(app)
                     : *shell == "zsh" ? zsh_completion(app)
                                       : fish_completion(app));
  });
  app.add_subcommand("man", "Print the manual page")->callback([&app, version] {
    fmt::print("{}", man_page(app, version));
  });
}

}  // namespace kinebus
