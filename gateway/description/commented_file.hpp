#pragma once
// A machine file as write_machine() has it, with the comments that the shipped files have beside the same
// keys.

#include <map>
#include <span>
#include <string>
#include <string_view>

namespace kinebus {

struct FileRemarks {
  std::string header;                         ///< lines that begin with #; at the top
  std::map<std::string, std::string> tables;  ///< by a table's name: one line above it, without #
};

/// `written` with remarks and, where a key comes for the first time, with the comment that the first of
/// `examples` that has this key in such a table ([joint.*], [node.*.input*]) has behind or above it.
std::string with_comments(std::string_view written, std::span<const std::string_view> examples,
                          const FileRemarks& remarks);

}  // namespace kinebus
