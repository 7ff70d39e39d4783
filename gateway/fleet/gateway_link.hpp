#pragma once
// One gateway by its job link, as an agent needs it: what is there, and what is asked of it. Throws
// ClientError when the gateway does not answer or refuses.

#include <cstdint>
#include <optional>
#include <string>

#include "gateway/fleet/job.hpp"
#include "tools/cli/client.hpp"

namespace kinebus::fleet {

class GatewayLink {
 public:
  explicit GatewayLink(const Reach& reach) : client_(reach) {}

  /// `job`: whose run is looked for in the history.
  GatewayFacts look(const std::optional<QueuedJob>& job);
  /// Sends the text under the ticket's name, unless it is there, and starts it.
  void start(const QueuedJob& job, const std::string& text);
  /// The same with a text that the check before motion refuses.
  void use_up(const QueuedJob& job);
  void cancel();
  /// Towards known positions, a step: brings the nodes up, or homes.
  void home();
  /// The ticket's text is not needed any more.
  void forget(const QueuedJob& job);

 private:
  joblink::Reply command(joblink::ClientMessage message);
  std::optional<TicketRun> find_run(const QueuedJob& job, bool& short_history);

  Client client_;
};

}  // namespace kinebus::fleet
