#include "gateway/sessions/http/routes.hpp"

#include <algorithm>

namespace kinebus::http {
namespace {

/// Of a request that is read whole.
constexpr std::size_t kMaxBody = 64U << 10;

class SmallTask : public Task {
 public:
  SmallTask(Session& session, const Route& route) : session_(session), route_(route) {}
  void begin() override {
    if (session_.head().content_length.value_or(0) > kMaxBody) refuse();
  }
  void on_body(std::string_view bytes) override {
    if (body_.size() + bytes.size() > kMaxBody) return refuse();
    body_ += bytes;
  }
  void on_end() override { route_.carry_out(session_, body_); }

 private:
  void refuse() { session_.refuse(413, "the body of such a request has at most 64 KiB"); }
  Session& session_;
  const Route& route_;
  std::string body_;
};

bool fits(std::string_view pattern, const std::vector<std::string>& path) {
  std::size_t at = 0;
  while (!pattern.empty()) {
    const std::size_t end = std::min(pattern.find('/'), pattern.size());
    const std::string_view piece = pattern.substr(0, end);
    pattern.remove_prefix(std::min(end + 1, pattern.size()));
    if (at >= path.size()) return false;
    if (piece == "**") return true;
    if (piece != "*" && piece != path[at]) return false;
    ++at;
  }
  return at == path.size();
}

}  // namespace

Found find_route(std::string_view method, const std::vector<std::string>& path) {
  Found found;
  for (const auto routes : {octoprint_machine_routes(), octoprint_control_routes(), octoprint_job_routes(),
                            octoprint_push_routes(), prusalink_routes(), kinebus_routes(), moonraker_routes(),
                            metrics_routes(), page_routes()})
    for (const Route& route : routes) {
      if (!fits(route.path, path)) continue;
      if (method == route.method) {
        if (found.route == nullptr) found.route = &route;
      }
      if (found.allowed.find(route.method) != std::string::npos) continue;
      found.allowed += (found.allowed.empty() ? "" : ", ") + std::string(route.method);
    }
  return found;
}

std::unique_ptr<Task> make_task(const Route& route, Session& session) {
  if (route.make != nullptr) return route.make(session);
  return std::make_unique<SmallTask>(session, route);
}

}  // namespace kinebus::http
