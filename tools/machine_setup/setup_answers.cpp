// As the reader of machine files has it.
#include "gateway/toml.hpp"

#include "tools/machine_setup/setup_answers.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace kinebus {

Result<SetupAnswers, std::string> SetupAnswers::load(const std::filesystem::path& file) {
  SetupAnswers answers;
  answers.file_ = file;
  std::error_code ignored;
  if (!std::filesystem::exists(file, ignored)) return answers;
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  const toml::parse_result parsed = toml::parse(text.view());
  if (!parsed)
    return Error<std::string>(fmt::format("{}:{}: {}; remove it to begin anew", file.string(),
                                          parsed.error().source().begin.line, parsed.error().description()));
  for (const auto& [key, value] : parsed.table()) {
    const auto word = value.value<std::string>();
    if (!word)
      return Error<std::string>(fmt::format("{}:{}: {}: expected a text in quotes", file.string(),
                                            value.source().begin.line, key.str()));
    answers.answers_[std::string(key.str())] = *word;
  }
  return answers;
}

std::optional<std::string> SetupAnswers::get(const std::string& key) const {
  const auto found = answers_.find(key);
  if (found == answers_.end()) return std::nullopt;
  return found->second;
}

void SetupAnswers::set(const std::string& key, const std::string& value) {
  answers_[key] = value;
  save();
}

void SetupAnswers::forget(const std::string& beginning) {
  std::erase_if(answers_, [&](const auto& answer) { return answer.first.starts_with(beginning); });
  save();
}

void SetupAnswers::save() const {
  toml::table table;
  for (const auto& [key, value] : answers_) table.insert(key, value);
  std::ostringstream text;
  text << "# Answers to kinebus-setup, which goes on from here. Remove this file to begin anew.\n"
       << table << '\n';
  write_file(file_, text.str());
}

void write_file(const std::filesystem::path& file, const std::string& text) {
  const std::filesystem::path beside = file.string() + ".new";
  std::FILE* out = std::fopen(beside.c_str(), "wb");
  bool good = out != nullptr;
  if (good) {
    good = std::fwrite(text.data(), 1, text.size(), out) == text.size() && std::fflush(out) == 0 &&
           ::fsync(::fileno(out)) == 0;
    good = std::fclose(out) == 0 && good;
  }
  good = good && std::rename(beside.c_str(), file.c_str()) == 0;
  if (!good) throw std::runtime_error(file.string() + " cannot be written");
}

}  // namespace kinebus
