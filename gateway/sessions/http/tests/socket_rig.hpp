#pragma once
// A websocket's client in memory: what it says, and the frames it has heard.

#include <string>
#include <vector>

#include "gateway/sessions/http/tests/http_rig.hpp"
#include "gateway/sessions/http/wire/websocket.hpp"

namespace kinebus::http {

/// A client's frame, masked. `first`: FIN, reserved bits and opcode.
inline std::string masked(std::uint8_t first, const std::string& payload) {
  std::string bytes(1, static_cast<char>(first));
  const std::size_t n = payload.size();
  if (n < 126) {
    bytes += static_cast<char>(0x80 | n);
  } else {
    bytes += static_cast<char>(0x80 | 126);
    bytes.append(1, static_cast<char>(n >> 8)).append(1, static_cast<char>(n & 0xFF));
  }
  const std::string mask = "\x11\xA2\x33\xC4";
  bytes += mask;
  for (std::size_t i = 0; i < n; ++i) bytes += static_cast<char>(payload[i] ^ mask[i % 4]);
  return bytes;
}
inline std::string said(const std::string& text) {
  return masked(0x81, text);
}

struct Heard {
  Opcode opcode{};
  std::string payload;
  nlohmann::json json() const { return nlohmann::json::parse(payload, nullptr, false); }
  unsigned code() const {
    return payload.size() < 2 ? 0U
                              : static_cast<unsigned>(static_cast<unsigned char>(payload[0])) << 8U |
                                    static_cast<unsigned char>(payload[1]);
  }
};

/// The whole frames that were heard are taken out.
inline std::vector<Heard> frames_of(std::string& heard) {
  std::vector<Heard> frames;
  const auto byte = [&](std::size_t at) { return static_cast<unsigned char>(heard[at]); };
  while (heard.size() >= 2) {
    std::size_t head = 2, length = byte(1);
    const std::size_t more = length == 127 ? 8 : length == 126 ? 2 : 0;
    if (heard.size() < head + more) break;
    if (more > 0) length = 0;
    for (std::size_t i = 0; i < more; ++i) length = length << 8U | byte(head + i);
    head += more;
    if (heard.size() < head + length) break;
    frames.push_back({static_cast<Opcode>(byte(0) & 0x0F), heard.substr(head, length)});
    heard.erase(0, head + length);
  }
  return frames;
}

inline std::string handshake(const std::string& path, const std::string& fields) {
  return "GET " + path + " HTTP/1.1\r\nHost: 127.0.0.1:5000\r\n" + fields +
         "Upgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
         "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n";
}

class SocketClient {
 public:
  /// `key`: what it shows with its request; empty: nothing.
  SocketClient(HttpRig& rig, const std::string& path, const std::string& key = kKey)
      : rig_(rig), wire(rig.connect()) {
    EXPECT_EQ(rig_.ask(wire, handshake(path, key.empty() ? "" : "X-Api-Key: " + key + "\r\n")).status, 101);
  }
  /// Says `text` and gives what was heard then.
  std::vector<Heard> say(const std::string& text) { return send(said(text)); }
  std::vector<Heard> send(const std::string& bytes, std::size_t piece = 4000) {
    wire.to_send += bytes;
    rig_.pump(piece);
    return frames_of(wire.heard);
  }
  std::vector<Heard> hear(BusTime time) {
    rig_.run_until([] { return false; }, time);
    return frames_of(wire.heard);
  }

 private:
  HttpRig& rig_;

 public:
  Connection& wire;
};

}  // namespace kinebus::http
