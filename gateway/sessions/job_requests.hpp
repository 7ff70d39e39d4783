#pragma once
// Requests about jobs, their store and the machine file: everything that goes through the worker.

#include "gateway/sessions/job_link_server.hpp"
#include "protocol/joblink/upload_chunk.hpp"

namespace kinebus {

class JobRequests {
 public:
  JobRequests(JobLinkServer& server, JobLinkSession& session, LocalTime now)
      : server_(server), session_(session), now_(now) {}
  /// False: not one of these.
  bool take(const JobLinkServer::Asker& asker, const joblink::ClientMessage& message);
  void chunk(const JobLinkServer::Asker& asker, const joblink::ChunkView& chunk);

 private:
  using Asker = JobLinkServer::Asker;
  void begin_upload(const Asker& asker, const joblink::UploadBegin& request);
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

  JobLinkServer& server_;
  JobLinkSession& session_;
  LocalTime now_;
};

}  // namespace kinebus
