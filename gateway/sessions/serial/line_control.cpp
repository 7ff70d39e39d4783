// A print host among the clients: who it is, when it comes and goes, and what it may do.

#include "gateway/sessions/serial/line_control.hpp"

#include <algorithm>
#include <array>

#include "gateway/sessions/serial/marlin_session.hpp"

namespace kinebus {

bool serial::changes_machine(const Code& code) {
  // Stored jobs, temperatures, positions, reports, the dialect itself; M108, M112 and M410 were seen when
  // they came.
  static constexpr std::array kFree{20,  21,  22,  23,  26,  27,  28,  29,  30,  105, 108,
                                    110, 112, 113, 114, 115, 118, 119, 155, 410, 503};
  return code.letter != 'M' || std::find(kFree.begin(), kFree.end(), code.number) == kFree.end();
}

void MarlinSession::heard() {
  if (options_.control == nullptr || client_ != 0) return;
  client_ = options_.control->attach("print host on " + options_.name, options_.transport);
}

void MarlinSession::leave() {
  if (options_.control != nullptr && client_ != 0) options_.control->detach(client_);
  client_ = 0;
}

void MarlinSession::come_and_go() {
  if (client_ == 0 || !idle()) return;
  // Hosts ask for temperatures for ever: what they commanded is done, others need not take control by force.
  if (has_control() && now_ >= last_command_ + options_.close_after) options_.control->release(client_);
  if (now_ >= last_line_ + options_.gone_after) leave();
}

bool MarlinSession::may_command() {
  last_command_ = now_;
  return options_.control == nullptr || options_.control->may_command(client_);
}

std::string MarlinSession::no_control() const {
  return options_.control->name_of(options_.control->holder()) + " has control of the machine";
}

}  // namespace kinebus
