#pragma once
// Inside of the job store: a half upload on the disk.

#include <filesystem>
#include <string_view>

#include "gateway/jobs/store/job_store.hpp"
#include "protocol/joblink/job_hash.hpp"

namespace kinebus {

inline constexpr std::string_view kPartialPrefix = ".upload-";
inline constexpr std::string_view kKeptPrefix = ".kept-";

struct JobStore::Upload {
  std::uint32_t id = 0;
  UploadIdentity identity;
  bool replace = false;
  int fd = -1;
  std::uint64_t received_bytes = 0;
  std::uint64_t secured_bytes = 0;  ///< known to be on the disk, whatever happens
  joblink::JobHash sum;

  Upload() = default;
  ~Upload();
  Upload(const Upload&) = delete;
  Upload& operator=(const Upload&) = delete;
};

StoreError disk_error(const std::filesystem::path& path, int error);
/// The folder's entries are on the disk.
void sync_folder(const std::filesystem::path& folder);

}  // namespace kinebus
