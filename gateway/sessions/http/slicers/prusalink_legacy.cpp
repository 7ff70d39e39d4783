// Paths that OctoPrint and PrusaLink share and answer in two ways: here as PrusaLink does.

#include <utility>

#include "gateway/sessions/http/slicers/octoprint.hpp"

namespace kinebus::http {
namespace {

/// As printers with PrusaLink call theirs.
constexpr const char* kFolder = "/usb";

Json child_json(const StoredJob& job) {
  return {{"name", job.name},
          {"display", job.name},
          {"path", std::string(kFolder) + "/" + job.name},
          {"origin", "usb"},
          {"type", "machinecode"},
          {"size", job.size_bytes},
          {"date", static_cast<std::int64_t>(job.stored_unix_s)},
          {"refs", {{"download", download_path(job.name)}}}};
}

}  // namespace

void prusalink_files(Session& session) {
  session.beside(
      [](JobStore& store) {
        const auto listing = all_jobs(store);
        if (!listing) return Result<std::string, StoreError>(Error<StoreError>(listing.error()));
        Json children = Json::array();
        for (const StoredJob& job : listing->jobs) children.push_back(child_json(job));
        const Json folder = {{"name", "usb"},    {"display", "usb"}, {"path", kFolder},
                             {"type", "folder"}, {"origin", "usb"},  {"children", std::move(children)}};
        return Result<std::string, StoreError>(text_of({{"files", Json::array({folder})}}));
      },
      [&session](Result<std::string, StoreError> text) {
        if (!text) return session.refuse(500, text.error().words);
        session.answer({.body = std::move(*text)});
      });
}

Json prusalink_job_json(Json octoprint) {
  static constexpr double kWhole = 100;
  Json& completion = octoprint["progress"]["completion"];
  if (completion.is_number()) completion = completion.get<double>() / kWhole;
  return octoprint;
}

}  // namespace kinebus::http
