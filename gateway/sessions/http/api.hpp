#pragma once
// What both APIs are made of: JSON of the machine's state and of stored jobs, and commands with their answer.

#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "gateway/sessions/http/http_session.hpp"

namespace kinebus::http {

using Json = nlohmann::ordered_json;

/// The version of OctoPrint whose API this is, as far as it goes: clients compare it.
inline constexpr const char* kOctoPrintApi = "1.9.0";

std::string text_of(const Json& json);
Answer json_answer(const Json& json, int status = 200);
Answer no_content();
/// nullopt: refused already.
std::optional<Json> json_body(Session& session, std::string_view body);
/// All stored jobs, as the worker reads them.
Result<JobListing, StoreError> all_jobs(JobStore& store);
/// The text under `key`; "": there is none.
std::string word_in(const Json& object, const char* key);

joblink::Status machine_status(Caller& caller);
joblink::MachineInfo machine_info(Caller& caller);
/// Progress of the job as a share, 0..1.
bool job_is_there(const joblink::Status& status);
bool is_paused(const joblink::Status& status);

/// 204, or why not.
void command(Session& session, const joblink::ClientMessage& message);
/// Starts a stored job: `then` hears why not, or a problem without rule when it has passed its pre-flight or
/// that takes longer than a client waits.
void begin_job(Caller& caller, const std::string& name, std::function<void(const joblink::Problem&)> then);
/// "the rule (what is expected)"
std::string words_of(const joblink::Problem& problem);
/// Starts a stored job, and tells how that went: `started` is called when it has passed its pre-flight, or
/// when that takes longer than a client waits; what is wrong with it is the request's answer.
void start_job(Session& session, const std::string& name, std::function<void()> started);
/// False: the request is refused, since who asks may only watch.
bool may_operate(Session& session);
/// 204, 404 or 409.
void delete_job(Session& session, const std::string& name);
/// What is known of a stored job is given to `found`; 404 where there is none.
void with_job(Session& session, const std::string& name, std::function<void(const StoredJob&)> found);
/// The job's text.
std::unique_ptr<Task> download(Session& session, std::string name);

enum class Pausing : std::uint8_t { kPause, kResume, kToggle };
joblink::ClientMessage pause_message(Pausing pausing, bool is_paused);
void pause(Session& session, Pausing pausing);
void cancel(Session& session);

/// "/downloads/files/local/a%20b.gcode"
std::string download_path(const std::string& name);

}  // namespace kinebus::http
