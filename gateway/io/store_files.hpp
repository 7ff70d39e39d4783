#pragma once
// The job store as print hosts on a serial line know it (M20 to M32): answered at once, from the files alone;
// what has to wait for the disk follows beside the loop.

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>

#include "gateway/jobs/store/job_store.hpp"
#include "gateway/sessions/job_link_server.hpp"
#include "gateway/sessions/serial/serial_files.hpp"
#include "gateway/sessions/worker.hpp"

namespace kinebus {

class StoreFiles : public SerialFiles {
 public:
  /// `store` belongs to `worker`: only its folder is used here.
  StoreFiles(JobStore& store, Worker& worker, Gateway& gateway, JobLinkServer& server);
  std::vector<Entry> list() override;
  Result<std::unique_ptr<ByteSource>, std::string> open(std::string_view name) override;
  std::string run(std::string_view name) override;
  std::string remove(std::string_view name) override;
  std::string store(std::string_view name, std::string_view text) override;

 private:
  /// Where the job's text is.
  std::filesystem::path path_of(const std::string& name) const;

  JobStore& store_;
  Worker& worker_;
  Gateway& gateway_;
  JobLinkServer& server_;
  std::filesystem::path folder_;
  /// Files on their way to the disk, by the name that they will have.
  std::map<std::string, std::filesystem::path> written_;
  std::uint64_t next_written_ = 1;
};

}  // namespace kinebus
