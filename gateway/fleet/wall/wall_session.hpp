#pragma once
// One browser at the wall of machines, sans-IO: reads HTTP/1.1, answers with the page or with what is known
// now. Nothing can be changed here.

#include <string>

#include "gateway/fleet/wall/wall_text.hpp"
#include "gateway/sessions/byte_session.hpp"
#include "gateway/sessions/http/wire/http_reader.hpp"

namespace kinebus::fleet {

class WallSession : public ByteSession {
 public:
  explicit WallSession(const WallText& text) : text_(text) {}

  void on_bytes(LocalTime now, std::span<const std::uint8_t> bytes) override;
  void on_time(LocalTime now) override;
  LocalTime next_deadline() const override { return silent_until_; }
  std::span<const std::uint8_t> next_bytes() override;
  void on_bytes_sent(std::size_t count) override;
  /// A client that asks without reading waits.
  bool wants_bytes() const override { return out_.empty(); }
  bool ended() const override { return ended_; }
  void on_closed(LocalTime, std::string_view) override { ended_ = true; }

 private:
  void work();
  void answer(const http::Head& head);
  void say(int status, const char* type, const std::string& body, bool keep);

  const WallText& text_;
  http::Reader reader_;
  std::string in_, out_;
  LocalTime silent_until_ = LocalTime::max();
  bool ended_ = false;
};

}  // namespace kinebus::fleet
