// The web page's files. They tell nothing of the machine: who has not shown the key gets them, too, and the
// page asks for the key.

#include <array>
#include <string>

#include "gateway/description/camera_address.hpp"
#include "gateway/sessions/http/http_session.hpp"
#include "gateway/sessions/http/routes.hpp"

namespace kinebus::http {
namespace {

/// The page is one origin's own: no foreign scripts, in no foreign frame, and no foreign pictures but those
/// of the machine's cameras. `host`: what the reader calls this computer.
std::string policy(const joblink::MachineInfo& machine, std::string_view host) {
  std::string cameras;
  for (const joblink::Camera& camera : machine.cameras())
    cameras.append(" ").append(camera_origin(camera_address_from(camera.stream(), host)));
  return "default-src 'self'; img-src 'self' data: blob:" + cameras +
         "; object-src 'none'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";
}

void page(Session& session, std::string_view) {
  std::string name;
  for (const std::string& piece : session.target().path) name += (name.empty() ? "" : "/") + piece;
  name = name.empty() ? "index.html" : name.substr(sizeof("page/") - 1);
  const Pages& pages = session.server().options().pages;
  const auto found = pages.find(name);
  if (found == pages.end())
    return session.refuse(404,
                          pages.empty() ? "the web page is not installed" : "the web page has no such file");
  const Page& file = found->second;
  Answer answer{.type = file.type, .may_be_kept = true};
  answer.fields = {
      {"ETag", "\"" + file.mark + "\""},
      {"Vary", "Accept-Encoding"},
      {"Content-Security-Policy", policy(session.server().link().machine(), session.head().field("Host"))},
      {"Referrer-Policy", "no-referrer"}};
  if (session.head().field("If-None-Match").find(file.mark) != std::string_view::npos) {
    answer.status = 304;
    return session.answer(answer);
  }
  const bool gzip =
      !file.gzip.empty() && session.head().field("Accept-Encoding").find("gzip") != std::string_view::npos;
  if (gzip) answer.fields.emplace_back("Content-Encoding", "gzip");
  answer.body = gzip ? file.gzip : file.bytes;
  session.answer(answer);
}

}  // namespace

std::span<const Route> page_routes() {
  static constexpr std::array kRoutes{
      Route{.method = "GET", .path = "", .carry_out = page, .open = true},
      Route{.method = "GET", .path = "page/**", .carry_out = page, .open = true},
  };
  return kRoutes;
}

}  // namespace kinebus::http
