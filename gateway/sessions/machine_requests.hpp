#pragma once
// Requests to the machine itself, and about who may make them.

#include "gateway/sessions/job_link_server.hpp"
#include "gateway/sessions/requester.hpp"

namespace kinebus {

class MachineRequests {
 public:
  MachineRequests(JobLinkServer& server, Requester& requester) : server_(server), requester_(requester) {}
  /// False: not one of these.
  bool take(const JobLinkServer::Asker& asker, const joblink::ClientMessage& message);

 private:
  using Asker = JobLinkServer::Asker;
  bool take_free(const Asker& asker, const joblink::ClientMessage& message);
  bool take_control_request(const Asker& asker, const joblink::ClientMessage& message);
  void carry_out(const Asker& asker, const joblink::ClientMessage& message);
  void start(const Asker& asker, const std::string& name);
  void console(const Asker& asker, const std::string& line);

  JobLinkServer& server_;
  Requester& requester_;
};

}  // namespace kinebus
