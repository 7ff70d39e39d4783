#pragma once
// What shells and man need to know of a command line, made of the command line itself.

#include <CLI/CLI.hpp>
#include <string>

namespace kinebus {

std::string bash_completion(const CLI::App& app);
std::string zsh_completion(const CLI::App& app);
std::string fish_completion(const CLI::App& app);
/// Section 1, in roff.
std::string man_page(const CLI::App& app, const std::string& version);

/// Adds `completion` and `man`, which print these.
void add_shell_words(CLI::App& app, const std::string& version);

}  // namespace kinebus
