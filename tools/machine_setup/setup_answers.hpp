#pragma once
// What has been answered and tested so far, in a small TOML file beside the machine file, so that a set-up
// that was interrupted goes on where it was.

#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "gateway/result.hpp"

namespace kinebus {

class SetupAnswers {
 public:
  /// A file that is not there is one without answers. Error: file, line and what is wrong.
  static Result<SetupAnswers, std::string> load(const std::filesystem::path& file);

  const std::filesystem::path& file() const { return file_; }
  bool empty() const { return answers_.empty(); }
  std::optional<std::string> get(const std::string& key) const;
  /// On the disk when it returns. Throws std::runtime_error when it cannot be written.
  void set(const std::string& key, const std::string& value);
  /// Of the keys that begin so, none is known any more.
  void forget(const std::string& beginning);

 private:
  void save() const;

  std::filesystem::path file_;
  std::map<std::string, std::string> answers_;
};

/// Whole or not at all. Throws std::runtime_error.
void write_file(const std::filesystem::path& file, const std::string& text);

}  // namespace kinebus
