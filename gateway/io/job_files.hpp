#pragma once
// Jobs as files in one folder: stored whole or not at all, and read while they run.

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "gateway/jobs/byte_source.hpp"
#include "gateway/result.hpp"

namespace kinebus {

/// A file as the text of a job.
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

/// The folder of stored jobs. Names are plain file names: nothing outside the folder can be reached.
class JobFolder {
 public:
  struct Entry {
    std::string name;
    std::uint64_t bytes = 0;
  };
  explicit JobFolder(std::filesystem::path folder) : folder_(std::move(folder)) {}

  /// Empty: fine. Otherwise the rule that the name breaks.
  static std::string check_name(std::string_view name);

  std::string prepare();  ///< makes the folder, removes half uploads; empty: fine
  std::vector<Entry> list() const;
  Result<std::unique_ptr<FileSource>, std::string> open(std::string_view name) const;
  std::string remove(std::string_view name);

  const std::filesystem::path& path() const { return folder_; }

 private:
  std::filesystem::path folder_;
};

/// One upload: bytes go to a hidden file, which takes its name only when all of it is on the disk.
class JobUpload {
 public:
  static Result<JobUpload, std::string> begin(const JobFolder& folder, std::string_view name,
                                              std::uint64_t bytes);
  JobUpload(JobUpload&& other) noexcept;
  JobUpload& operator=(JobUpload&& other) noexcept;
  ~JobUpload();

  std::uint64_t missing() const { return missing_; }
  std::string write(std::string_view bytes);  ///< empty: fine
  std::string finish();                       ///< empty: stored

 private:
  JobUpload() = default;
  int fd_ = -1;
  std::filesystem::path hidden_, final_;
  std::uint64_t missing_ = 0;
};

}  // namespace kinebus
