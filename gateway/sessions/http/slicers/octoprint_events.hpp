#pragma once
// What happens to the machine and its job, as OctoPrint's events (docs.octoprint.org/en/master/events).

#include <string>
#include <utility>
#include <vector>

#include "gateway/sessions/http/api.hpp"

namespace kinebus::http {

class OctoPrintEvents {
 public:
  /// As the machine is when a client comes.
  OctoPrintEvents(const joblink::Status& status, bool in_job);

  /// Names and payloads, in their order; `status`: of now.
  std::vector<std::pair<const char*, Json>> of(const joblink::Event& event, const joblink::Status& status);

 private:
  using Told = std::vector<std::pair<const char*, Json>>;
  void on_state(const joblink::Event& event, Told& told);
  Json job() const;
  Json ended(double time_s, const char* reason) const;

  joblink::State state_;
  bool in_job_, runs_, cancelled_ = false;
  std::string name_;
  double begun_s_ = 0, paused_s_ = 0, pause_began_s_ = 0;  ///< pauses are not counted as printing
};

}  // namespace kinebus::http
