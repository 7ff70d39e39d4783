#pragma once
// OctoPrint's REST API (docs.octoprint.org/en/master/api), as far as slicers, apps and managers of printers
// use it. What Kinebus does not have is left out, not made up.

#include <memory>
#include <string>

#include "gateway/sessions/http/api.hpp"
#include "gateway/sessions/http/http_session.hpp"

namespace kinebus::http {

/// What a visitor is called: users by their names.
std::string octoprint_user(const Visitor& visitor);

/// The machine's state as OctoPrint's clients know it: "Operational", "Printing".
const char* octoprint_state(const joblink::Status& status);
/// The same with flags: "state" of /api/printer.
Json octoprint_state_json(const joblink::Status& status);
/// "tool0", "bed", "chamber", as OctoPrint names heaters.
std::string octoprint_heater(const joblink::Heater& heater);
/// By heater: "actual" and "target".
Json octoprint_temperatures(const joblink::Status& status);
/// The job that is there, or the file that is selected; "": neither.
const std::string& octoprint_job_name(const joblink::Status& status, const std::string& selected);
/// "job", "progress" and "state" of /api/job. `job`: what the store knows of it; nullptr: nothing.
Json octoprint_job_json(const joblink::Status& status, const std::string& selected, const StoredJob* job);

/// GET /api/files as PrusaLink answers it: one folder.
void prusalink_files(Session& session);
/// octoprint_job_json() as PrusaLink has it: completion is a share of 1.
Json prusalink_job_json(Json octoprint);

/// POST /api/files/local
std::unique_ptr<Task> octoprint_upload(Session& session);
/// The same form for Moonraker: POST /server/files/upload
std::unique_ptr<Task> moonraker_upload(Session& session);

}  // namespace kinebus::http
