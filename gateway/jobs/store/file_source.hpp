#pragma once
// A file as the text of a job.

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>

#include "gateway/jobs/byte_source.hpp"
#include "gateway/result.hpp"

namespace kinebus {

class FileSource : public ByteSource {
 public:
  static Result<std::unique_ptr<FileSource>, std::string> open(const std::filesystem::path& path);
  std::size_t read(std::span<char> buffer) override;
  bool rewind() override;
  std::optional<std::uint64_t> size() const override { return size_; }

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  std::unique_ptr<std::FILE, Close> file_;
  std::uint64_t size_ = 0;
};

}  // namespace kinebus
