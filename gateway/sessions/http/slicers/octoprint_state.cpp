// The machine and its job as OctoPrint's clients read them, by request and by websocket alike.

#include "gateway/sessions/http/pictures.hpp"
#include "gateway/sessions/http/slicers/octoprint.hpp"

namespace kinebus::http {
namespace {

struct Flags {
  const char* text;  ///< as OctoPrint's clients know it
  bool operational = true, printing = false, pausing = false, cancelling = false, ready = false,
       error = false;
};

Flags flags_of(joblink::State state) {
  switch (state) {
    case joblink::STATE_OFF:
      return {.text = "Offline", .operational = false};
    case joblink::STATE_BRING_UP:
      return {.text = "Connecting", .operational = false};
    case joblink::STATE_READY:
      return {.text = "Operational", .ready = true};
    case joblink::STATE_CHECKING:
      return {.text = "Starting", .printing = true};
    case joblink::STATE_RUNNING:
      return {.text = "Printing", .printing = true};
    case joblink::STATE_HOLDING:
      return {.text = "Pausing", .printing = true, .pausing = true};
    case joblink::STATE_HELD:
      return {.text = "Paused"};
    case joblink::STATE_CANCELLING:
      return {.text = "Cancelling", .cancelling = true};
    case joblink::STATE_STOPPING:
    case joblink::STATE_STOPPED:
    case joblink::STATE_ALARM:
      return {.text = "Error", .operational = false, .error = true};
    default:
      return {.text = "Operational"};
  }
}

}  // namespace

std::string octoprint_user(const Visitor& visitor) {
  return visitor.name.empty() ? "kinebus" : visitor.name;
}

const char* octoprint_state(const joblink::Status& status) {
  return is_paused(status) ? "Paused" : flags_of(status.state()).text;
}

Json octoprint_state_json(const joblink::Status& status) {
  const Flags flags = flags_of(status.state());
  return {{"text", octoprint_state(status)},
          {"flags",
           {{"operational", flags.operational},
            {"paused", is_paused(status)},
            {"printing", flags.printing},
            {"pausing", flags.pausing},
            {"cancelling", flags.cancelling},
            {"resuming", false},
            {"finishing", false},
            {"sdReady", false},
            {"error", flags.error},
            {"ready", flags.ready},
            {"closedOrError", !flags.operational}}},
          // In Kinebus's own words, for whoever reads them.
          {"kinebus", {{"state", status.state_words()}, {"doing", status.doing()}}}};
}

/// "tool0", "bed", "chamber", as OctoPrint names heaters.
std::string octoprint_heater(const joblink::Heater& heater) {
  const std::string number = std::to_string(heater.index());
  if (heater.kind() == joblink::HEATER_HOTEND) return "tool" + number;
  const std::string kind = heater.kind() == joblink::HEATER_BED ? "bed" : "chamber";
  return heater.index() == 0 ? kind : kind + number;
}

Json octoprint_temperatures(const joblink::Status& status) {
  Json temperatures = Json::object();
  for (const joblink::Heater& heater : status.heaters())
    temperatures[octoprint_heater(heater)] = {{"actual", heater.actual_celsius()},
                                              {"target", heater.target_celsius()}};
  return temperatures;
}

const std::string& octoprint_job_name(const joblink::Status& status, const std::string& selected) {
  return job_is_there(status) ? status.job() : selected;
}

Json octoprint_job_json(const joblink::Status& status, const std::string& selected, const StoredJob* job) {
  const bool runs = job_is_there(status);
  Json file = {{"name", nullptr},   {"path", nullptr}, {"display", nullptr},
               {"origin", nullptr}, {"size", nullptr}, {"date", nullptr}};
  const std::string& name = octoprint_job_name(status, selected);
  if (!name.empty()) {
    file["name"] = file["path"] = file["display"] = name;
    file["origin"] = "local";
  }
  Json estimate = nullptr, filament = nullptr;
  if (job != nullptr) {
    file["size"] = job->size_bytes;
    file["date"] = static_cast<std::int64_t>(job->stored_unix_s);
    if (estimate_s(*job) > 0) estimate = estimate_s(*job);
    if (job->notes.filament_mm() > 0) filament = {{"tool0", {{"length", job->notes.filament_mm()}}}};
  }
  if (job != nullptr && job->preflight)
    estimate = job->preflight->motion_s + job->preflight->dwell_s;
  else if (runs)
    estimate = status.elapsed_s() + status.remaining_s();
  Json progress = {{"completion", nullptr},
                   {"filepos", nullptr},
                   {"printTime", nullptr},
                   {"printTimeLeft", nullptr},
                   {"printTimeLeftOrigin", nullptr}};
  if (runs)
    progress = {{"completion", 100 * status.progress()},
                {"filepos", job != nullptr ? Json(static_cast<std::uint64_t>(
                                                 status.progress() * static_cast<double>(job->size_bytes)))
                                           : Json(nullptr)},
                {"printTime", static_cast<std::int64_t>(status.elapsed_s())},
                {"printTimeLeft", static_cast<std::int64_t>(status.remaining_s())},
                {"printTimeLeftOrigin", "estimate"}};
  return {{"job",
           {{"file", file},
            {"estimatedPrintTime", estimate},
            {"lastPrintTime", nullptr},
            {"filament", filament}}},
          {"progress", progress},
          {"state", octoprint_state(status)}};
}

}  // namespace kinebus::http
