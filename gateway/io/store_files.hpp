#pragma once
// The job store as print hosts on a serial line know it (M20 to M32), asked beside the loop.

#include <string>
#include <string_view>

#include "gateway/jobs/store/job_store.hpp"
#include "gateway/sessions/job_link_server.hpp"
#include "gateway/sessions/serial/serial_files.hpp"
#include "gateway/sessions/worker.hpp"

namespace kinebus {

class StoreFiles : public SerialFiles {
 public:
  /// `store` belongs to `worker`.
  StoreFiles(JobStore& store, Worker& worker, Gateway& gateway, JobLinkServer& server);
  void list(const Asked& answer) override;
  void size(const Asked& answer, std::string_view name) override;
  void run(const Asked& answer, std::string_view name) override;
  void remove(const Asked& answer, std::string_view name) override;
  void store(const Asked& answer, std::string_view name, std::string text) override;

 private:
  JobStore& store_;
  Worker& worker_;
  Gateway& gateway_;
  JobLinkServer& server_;
};

}  // namespace kinebus
