#pragma once
// Requests about jobs, their store and the machine file: everything that goes through the worker.

#include "gateway/sessions/job_link_server.hpp"
#include "gateway/sessions/requester.hpp"
#include "protocol/joblink/upload_chunk.hpp"

namespace kinebus {

class JobRequests {
 public:
  JobRequests(JobLinkServer& server, Requester& requester, LocalTime now)
      : server_(server), requester_(requester), now_(now) {}
  /// False: not one of these.
  bool take(const JobLinkServer::Asker& asker, const joblink::ClientMessage& message);
  void chunk(const JobLinkServer::Asker& asker, const joblink::ChunkView& chunk);
  /// As JobStore::begin_open_ended(); chunks and commit follow as those of the job link's uploads do.
  void begin_open_ended(const JobLinkServer::Asker& asker, const std::string& name,
                        std::uint64_t expected_bytes, bool replace);

 private:
  using Asker = JobLinkServer::Asker;
  void begin_upload(const Asker& asker, const joblink::UploadBegin& request);
  template <typename Begin>
  void begin(const Asker& asker, Begin begin);
  void commit(const Asker& asker, const joblink::UploadCommit& request);
  void abort(const Asker& asker, const joblink::UploadAbort& request);
  void discard(const Asker& asker, const joblink::DiscardUpload& request);
  void refuse_upload(const Asker& asker);
  void list(const Asker& asker, const std::string& after);
  void remove(const Asker& asker, const std::string& name);
  void read(const Asker& asker, const joblink::ReadJob& request);
  void check(const Asker& asker, const std::string& name);
  void history(const Asker& asker, const joblink::GetHistory& request);
  void read_machine_file(const Asker& asker);
  void check_machine_file(const Asker& asker, const std::string& text);
  void write_machine_file(const Asker& asker, const joblink::WriteMachineFile& request);
  void restart(const Asker& asker);

  JobLinkServer& server_;
  Requester& requester_;
  LocalTime now_;
};

}  // namespace kinebus
