#pragma once
// The machine file on the disk: read whole, written whole.

#include <filesystem>

#include "gateway/sessions/machine_file_port.hpp"

namespace kinebus {

class MachineFileStore : public MachineFilePort {
 public:
  /// Empty path: the built-in machine, told as `built_in` and never written.
  MachineFileStore(std::filesystem::path path, std::string built_in)
      : path_(std::move(path)), built_in_(std::move(built_in)) {}
  Result<Text, Sentence> read() override;
  Result<void, Sentence> write(std::string_view text) override;

 private:
  std::filesystem::path path_;
  std::string built_in_;
};

}  // namespace kinebus
