#pragma once
// Which request is carried out by what. A request is small (its body is read whole before it is carried out)
// or has a task of its own.

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "gateway/sessions/http/http_session.hpp"

namespace kinebus::http {

struct Route {
  const char* method;
  const char* path;  ///< pieces; "*" stands for any one, "**" at the end for one or more
  void (*carry_out)(Session& session, std::string_view body);
  std::unique_ptr<Task> (*make)(Session& session) = nullptr;    ///< instead of carry_out
  std::unique_ptr<Dialect> (*speak)(Socket& socket) = nullptr;  ///< instead of both: a websocket
  bool open = false;                                            ///< for who has not shown the key, too
  bool commands = false;                                        ///< though it is a GET
};

struct Found {
  const Route* route = nullptr;
  std::string allowed{};  ///< the methods that this path takes; empty: there is nothing under it
};
Found find_route(std::string_view method, const std::vector<std::string>& path);
std::unique_ptr<Task> make_task(const Route& route, Session& session);

std::span<const Route> octoprint_machine_routes();
std::span<const Route> octoprint_control_routes();
std::span<const Route> octoprint_job_routes();
std::span<const Route> octoprint_push_routes();
std::span<const Route> prusalink_routes();
std::span<const Route> kinebus_routes();
std::span<const Route> moonraker_routes();
std::span<const Route> metrics_routes();
std::span<const Route> page_routes();

}  // namespace kinebus::http
