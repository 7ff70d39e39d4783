#pragma once
// The machine file on the disk, as the job link reads and writes it. Calls block: made beside the control
// loop.

#include <string>
#include <string_view>

#include "gateway/result.hpp"
#include "gateway/sentence.hpp"

namespace kinebus {

class MachineFilePort {
 public:
  struct Text {
    std::string text;
    std::string path;  ///< empty: the built-in machine, which cannot be written
    bool writable = false;
  };
  virtual ~MachineFilePort() = default;
  virtual Result<Text, Sentence> read() = 0;
  /// Stored whole or not at all; the file before is kept beside it.
  virtual Result<void, Sentence> write(std::string_view text) = 0;
};

}  // namespace kinebus
