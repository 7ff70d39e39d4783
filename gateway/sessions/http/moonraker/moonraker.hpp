#pragma once
// Moonraker's API (moonraker.readthedocs.io, external API), as far as web pages and apps for Klipper use it:
// JSON-RPC 2.0 over the websocket /websocket, and the same methods under their paths by HTTP. What Kinebus
// does not have is left out, not made up.

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "gateway/sessions/http/api.hpp"
#include "gateway/sessions/http/socket.hpp"

namespace kinebus::http {

struct RpcError {
  int code = 400;
  std::string message{};
};

/// What a socket subscribed to: objects with the fields that are wanted; null: all.
class MoonrakerDialect;

/// One method called: it ends with one of done() and fail(), now or later.
struct Call {
  Caller& caller;
  Json params;  ///< an object
  std::function<void(Result<Json, RpcError>)> then;
  MoonrakerDialect* socket = nullptr;  ///< nullptr: by HTTP

  void done(Json result) const { then(std::move(result)); }
  void fail(int code, std::string message) const {
    then(Error<RpcError>(RpcError{code, std::move(message)}));
  }
  /// False: it has failed, since who asks may only watch.
  bool may_operate() const;
  /// A request of the job link, answered with "ok" or why not.
  void command(const joblink::ClientMessage& message) const;
  /// The parameter as a text; "": there is none.
  std::string text(const char* name) const { return word_in(params, name); }
  /// The parameter as a number, which by HTTP comes as a text; `otherwise` where there is none.
  double number(const char* name, double otherwise) const;
};

struct Method {
  const char* name;  ///< "server.info"
  const char* verb;  ///< of HTTP; nullptr: over the websocket alone
  const char* path;  ///< "server/info"
  void (*carry_out)(const Call& call);
  bool open = false;  ///< for who has not shown the key, too
};
std::span<const Method> moonraker_server_methods();
std::span<const Method> moonraker_store_methods();
std::span<const Method> moonraker_printer_methods();
std::span<const Method> moonraker_file_methods();
std::span<const Method> moonraker_history_methods();
std::span<const Method> moonraker_webcam_methods();
/// Those that are refused: what Kinebus has not, said in words.
std::span<const Method> moonraker_refused_methods();
/// All of these.
std::vector<Method> moonraker_methods();
const Method* moonraker_method(std::string_view name);

/// Klipper's objects with what the machine is and does; `wanted` as of printer.objects.query: an object of
/// names, each null or a list of fields. Unknown names are left out.
Json moonraker_objects(Caller& caller, const Json& wanted);
std::vector<std::string> moonraker_object_names(Caller& caller);
/// What pages have changed in the database is written down.
void keep_database(Caller& caller);
/// "extruder", "heater_bed", "heater_generic NAME"; "temperature_sensor NAME"
std::string klipper_heater(const joblink::Heater& heater);
std::string klipper_sensor(const joblink::Sensor& sensor);
/// What all sensors read now.
void note_temperatures(Caller& caller, TemperatureCourse& course);
/// The newest run of the history is given to `then`; null: there is none.
void newest_run(Caller& caller, std::function<void(Json)> then);
/// "ready" or "shutdown", as Klipper's clients know it, and why.
const char* klippy_state(const joblink::Status& status);

/// GET /server/files/gcodes/.thumbs/NAME-WxH.png
void send_gcode_picture(Session& session, std::string_view body);

/// GET /websocket
std::unique_ptr<Dialect> moonraker_dialect(Socket& socket);
void subscribe(MoonrakerDialect& socket, Json wanted);
/// Lets the socket in that shows the key. False: it is wrong.
bool identify(MoonrakerDialect& socket, const std::string& name, const std::string& key);

}  // namespace kinebus::http
