#pragma once
// OctoPrint's REST API (docs.octoprint.org/en/master/api), as far as slicers, apps and managers of printers
// use it. What Kinebus does not have is left out, not made up.

#include <memory>

#include "gateway/sessions/http/http_session.hpp"

namespace kinebus::http {

/// The machine's state as OctoPrint's clients know it: "Operational", "Printing".
const char* octoprint_state(const joblink::Status& status);
/// POST /api/files/local
std::unique_ptr<Task> octoprint_upload(Session& session);
/// The same form for Moonraker: POST /server/files/upload
std::unique_ptr<Task> moonraker_upload(Session& session);

}  // namespace kinebus::http
