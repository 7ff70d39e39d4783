#pragma once
// A job on its way from a request's body into the store: begun, sent in pieces within the window, stored.
// What goes wrong is the request's answer.

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

#include "gateway/sessions/http/http_session.hpp"

namespace kinebus::http {

class JobStream {
 public:
  explicit JobStream(Session& session) : session_(session) {}

  /// `expected_bytes`: room that is kept for it; 0: unknown.
  void begin(const std::string& name, std::uint64_t expected_bytes, bool replace,
             std::function<void()> begun);
  bool begun() const { return upload_ != 0; }
  /// False: give no more now.
  bool takes_bytes() const { return begun() && session_.has_window(); }
  void write(std::string_view bytes);
  /// All was written: `stored` is called when the job has its name.
  void end(std::function<void()> stored);

  const std::string& name() const { return name_; }
  std::uint64_t bytes() const { return sent_ + piece_.size(); }

 private:
  void send();
  void refuse(const joblink::Problem& problem);

  Session& session_;
  std::string name_, piece_;
  std::uint32_t upload_ = 0;
  std::uint64_t sent_ = 0;
};

}  // namespace kinebus::http
