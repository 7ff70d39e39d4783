#pragma once
// HTTP for slicers, managers of printers and whoever looks at the machine: OctoPrint's and PrusaLink's
// requests, each carried out by the handlers of the job link.
//
//   open() -> a session for each connection (byte_session.hpp)      on_event: news of the machine
//   on_time: what is noted for clients that come later
//
// Who shows a key may do what its role is; who shows none and comes from no trusted network, nothing. Nobody
// can lock others out: connections that wait for nothing give way to new ones.

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "gateway/jobs/store/job_store.hpp"
#include "gateway/sessions/byte_session.hpp"
#include "gateway/sessions/control.hpp"
#include "gateway/sessions/http/digest.hpp"
#include "gateway/sessions/http/moonraker/course.hpp"
#include "gateway/sessions/http/moonraker/moonraker_database.hpp"
#include "gateway/sessions/http/slicers/login_sessions.hpp"
#include "gateway/sessions/http/users.hpp"
#include "gateway/sessions/job_link_server.hpp"
#include "gateway/sessions/worker.hpp"

namespace kinebus::http {

class Session;
class Caller;
class MoonrakerDialect;

/// A file of the web page.
struct Page {
  std::string type;  ///< "text/html; charset=utf-8"
  std::string bytes;
  std::string gzip;  ///< the same, compressed; empty: that saves nothing
  std::string mark;  ///< another one where the file has changed
};
using Pages = std::map<std::string, Page, std::less<>>;

class Server {
 public:
  struct Options {
    Users users;  ///< who may ask
    /// By which a client may call this computer (Host), besides its addresses and "localhost": a page of
    /// another name that leads here is refused.
    std::vector<std::string> names;
    std::size_t max_sessions = 32;
    /// The web page: files by their paths within its folder, all in memory.
    Pages pages{};
    /// What Moonraker's clients have kept here, as it was given to `keep_database`, which the worker calls.
    std::string database{};
    std::function<void(const std::string& text)> keep_database{};
    std::size_t max_sockets = 20;  ///< of these, so that there is room for requests
  };

  /// All must outlive it. `store` is touched by `worker` alone.
  Server(JobLinkServer& link, JobStore& store, Worker& worker, Control& control, Options options);
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  /// `peer`: whose places it takes. `address`: where it comes from, for Users::role_at.
  std::unique_ptr<ByteSession> open(LocalTime now, std::string transport, std::string peer,
                                    std::string_view address = {});
  /// From here on these may ask, and no others: who came in as somebody that is not there any more, or has
  /// another key or role, is put out, connections, websockets and log-ins. Returns how many connections.
  std::size_t take_users(LocalTime now, Users users);
  void on_event(const MachineEvent& event);
  void on_time(LocalTime now);
  LocalTime next_deadline() const { return next_note_; }

  JobLinkServer& link() { return link_; }
  JobStore& store() { return store_; }
  Worker& worker() { return worker_; }
  Control& control() { return control_; }
  const Options& options() const { return options_; }
  /// False: all are taken by who has shown the key.
  bool make_room_for_socket(LocalTime now);
  std::size_t sessions() const { return sessions_.size(); }

  /// The machine's status as the API of Kinebus tells it: made once for all who ask in this turn of the loop,
  /// and anew after a command.
  const std::string& status_json();
  /// The same, of some ms ago at most: for who hears it again and again.
  const std::string& recent_status_json(LocalTime now);

  /// What OctoPrint calls the selected file; empty: none.
  std::string selected;
  /// Counts the changes of the cameras that pages have entered.
  std::uint32_t webcams_revision = 0;
  /// Counts the jobs that were started, by whomever, since the gateway's start.
  std::uint32_t job_id() const { return job_id_; }
  /// How the last job ended, as Klipper's print_stats say it: "standby" before any.
  const char* job_end() const { return job_end_; }
  bool in_job() const { return in_job_; }
  /// Moonraker's clients that hold a websocket, by their numbers: requests subscribe for them.
  std::unordered_map<std::uint64_t, MoonrakerDialect*>& moonraker_sockets() { return moonraker_sockets_; }
  MoonrakerDatabase& database() { return database_; }
  const Users& users() const { return options_.users; }
  LoginSessions& logins() { return logins_; }
  Digest& digest() { return digest_; }
  const TemperatureCourse& temperatures() const { return temperatures_; }
  const ConsoleCourse& console() const { return console_; }
  /// A line that a client sent, or what it was answered.
  void note_line(LocalTime now, bool is_command, std::string_view text);
  double unix_s(LocalTime now) const;

 private:
  friend class Session;
  /// False: there is none.
  bool make_room(LocalTime now);

  JobLinkServer& link_;
  JobStore& store_;
  Worker& worker_;
  Control& control_;
  Options options_;
  std::unordered_map<std::uint64_t, Session*> sessions_;
  std::uint32_t job_id_ = 0;
  const char* job_end_ = "standby";
  bool in_job_ = false, ran_ = false, cancelled_ = false;
  std::unordered_map<std::uint64_t, MoonrakerDialect*> moonraker_sockets_;
  MoonrakerDatabase database_;
  LoginSessions logins_;
  Digest digest_;
  TemperatureCourse temperatures_;
  ConsoleCourse console_;
  std::unique_ptr<Caller> noter_;
  LocalTime next_note_{0};
  std::string status_json_;
  std::uint64_t status_made_ = 0;  ///< of which status it tells (JobLinkServer::statuses_made)
  LocalTime status_until_{0};
};

}  // namespace kinebus::http
