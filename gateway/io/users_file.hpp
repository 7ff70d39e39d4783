#pragma once
// The users of HTTP are those of their files: read at the daemon's start, and anew by the worker whenever one
// of the files is replaced or written, or the daemon is told to (SIGHUP). What is wrong then is logged, and
// those from before stay.

#include <csignal>
#include <filesystem>

#include "gateway/io/daemon_part.hpp"
#include "gateway/io/event_loop.hpp"
#include "gateway/sessions/http/http_server.hpp"
#include "gateway/sessions/worker.hpp"

namespace kinebus {

class UsersFile : public DaemonPart {
 public:
  struct Files {
    std::filesystem::path key;    ///< of the gateway; made where it is not there
    std::filesystem::path users;  ///< Users::read
    bool must_be_there = false;   ///< the users; else their key's holder is the only one
  };
  UsersFile(EventLoop& loop, Worker& worker, Files files);
  ~UsersFile() override;
  UsersFile(const UsersFile&) = delete;
  UsersFile& operator=(const UsersFile&) = delete;

  /// Waits for the disk. Error: file, place and rule.
  static Result<http::Users, std::string> read(const Files& files);
  /// From here on `server`, which must outlive it, has the users of the files; not 0 in `asked`: read them
  /// anew.
  void keep(http::Server& server, volatile std::sig_atomic_t* asked);

  void on_event(const MachineEvent&) override {}
  void on_time(LocalTime now) override;
  LocalTime next_deadline() const override { return reading_ ? LocalTime::max() : due_; }

 private:
  void watch(const std::filesystem::path& file);
  void on_changes();
  void take(Result<http::Users, std::string> users);

  EventLoop& loop_;
  Worker& worker_;
  Files files_;
  http::Server* server_ = nullptr;
  volatile std::sig_atomic_t* asked_ = nullptr;
  int changes_ = -1;  ///< of inotify
  LocalTime due_ = LocalTime::max();
  bool reading_ = false;
};

}  // namespace kinebus
