// Any bytes on websockets, in pieces of any length: as frames, and, when each line of the input is sent as
// one message, as what is said in them. Frames are the same however they are cut.

#include <string>

#include "gateway/sessions/http/tests/fuzz_machine.hpp"
#include "gateway/sessions/http/wire/websocket.hpp"

namespace kinebus::http {
namespace {

std::string story_of(std::string_view bytes, std::size_t piece) {
  FrameReader reader;
  std::string story;
  while (!bytes.empty()) {
    std::string_view rest = bytes.substr(0, piece);
    bytes.remove_prefix(rest.size());
    while (!rest.empty()) {
      const FrameReader::Taken taken = reader.take(rest);
      rest.remove_prefix(taken.count);
      check(reader.held_bytes() <= FrameReader::kMaxMessage + FrameReader::kMaxControl);
      if (taken.step == FrameReader::Step::kBad || taken.step == FrameReader::Step::kClose)
        return story + std::to_string(static_cast<int>(reader.code()));
      if (taken.step != FrameReader::Step::kMore)
        story.append(1, static_cast<char>(taken.step)).append(reader.payload());
    }
  }
  return story;
}

std::string message(std::string_view text) {
  // A mask of zeros.
  std::string bytes("\x81\xFE", 2);
  bytes.append(1, static_cast<char>(text.size() >> 8)).append(1, static_cast<char>(text.size()));
  return bytes.append(4, '\0').append(text);
}

std::string handshake(const std::string& path) {
  return "GET " + path +
         " HTTP/1.1\r\nHost: localhost\r\nX-Api-Key: k\r\nUpgrade: websocket\r\n"
         "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n";
}

}  // namespace
}  // namespace kinebus::http

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace kinebus;
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  http::check(http::story_of(bytes, size + 1) == http::story_of(bytes, 1));

  std::string messages;
  for (std::size_t at = 0; at < size;) {
    const std::string_view line = bytes.substr(at, bytes.find('\n', at) - at);
    at += line.size() + 1;
    // The frame is written with the longer length.
    messages +=
        http::message(std::string(line) + std::string(line.size() < 126 ? 126 - line.size() : 0, ' '));
  }
  for (const char* path :
       {"/kinebus/v1/socket", "/websocket", "/sockjs/websocket", "/sockjs/1/a/websocket"}) {
    http::FuzzMachine machine;
    machine.talk(http::handshake(path) + std::string(bytes), 61);
    machine.talk(http::handshake(path) + messages, size + 1000);
    http::check(machine.control.clients().empty());
  }
  return 0;
}
