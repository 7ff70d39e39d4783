#pragma once
// A file that only its owner may read, changed as a whole: whoever reads it meanwhile has the old one or the
// new one. Secrets that a person types are not shown. What goes wrong is thrown as words
// (std::runtime_error).

#include <filesystem>
#include <string>
#include <string_view>

namespace kinebus {

/// Holds a folder for itself among the programs that use this class: two changes do not undo each other.
class SecretFile {
 public:
  explicit SecretFile(const std::filesystem::path& file);
  ~SecretFile();
  SecretFile(const SecretFile&) = delete;
  SecretFile& operator=(const SecretFile&) = delete;

  /// Empty where it is not there. A file that others may read or write is refused.
  std::string read() const;
  /// Its owner stays; a new file's is the owner of its folder, who is to read it.
  void write(std::string_view text) const;

 private:
  std::filesystem::path file_;
  int folder_ = -1;
};

/// A line of standard input; at a terminal it is asked for by `prompt`, and not shown.
std::string read_secret(const char* prompt);

}  // namespace kinebus
