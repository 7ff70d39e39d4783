#pragma once
// A client that says in frames just what a test wants it to, in the order it wants.

#include <string>
#include <utility>
#include <vector>

#include "gateway/sessions/tests/link_rig.hpp"
#include "protocol/joblink/frame_codec.hpp"

namespace kinebus {

inline joblink::ClientMessage hello_of(const std::string& token = {}, const std::string& resume_key = {}) {
  joblink::ClientMessage message;
  message.mutable_hello()->set_version_major(joblink::kVersionMajor);
  message.mutable_hello()->set_client_name("raw");
  message.mutable_hello()->set_token(token);
  message.mutable_hello()->set_resume_key(resume_key);
  return message;
}

class RawClient {
 public:
  explicit RawClient(LinkRig& rig, SessionInfo info = {})
      : stream(rig.server->open(rig.machine.now, std::move(info))), rig_(rig) {}

  /// The next frame of the session, whole, and the gateway's turns until all of it is worked off.
  void say(const joblink::ClientMessage& message) {
    say_as(session, sequence++, message.SerializeAsString());
  }
  void say_as(std::uint32_t of_session, std::uint32_t number, const std::string& message) {
    std::string bytes;
    ASSERT_TRUE(joblink::append_frame(bytes, of_session, number, message));
    send(bytes);
    work();
  }
  /// Bytes alone: the gateway's turn has not come.
  void send(const std::string& bytes) {
    stream->on_bytes(rig_.machine.now, {reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
  }
  void work() {
    while (stream->next_deadline() <= LocalTime{0}) stream->on_time(rig_.machine.now);
    rig_.worker.run();
  }
  /// A session anew: its number, and the hello's reply.
  joblink::Reply greet(std::uint32_t number, const joblink::ClientMessage& hello = hello_of()) {
    session = number;
    sequence = 0;
    say(hello);
    return last_reply();
  }
  /// What has come since the last call.
  std::vector<joblink::ServerMessage> hear() {
    const auto bytes = stream->next_bytes();
    reader_.add(bytes);
    stream->on_bytes_sent(bytes.size());
    std::vector<joblink::ServerMessage> heard;
    while (const auto frame = reader_.next()) {
      heard_session = frame->session;
      EXPECT_TRUE(heard.emplace_back().ParseFromArray(frame->message.data(),
                                                      static_cast<int>(frame->message.size())));
    }
    return heard;
  }
  joblink::Reply last_reply() {
    joblink::Reply reply;
    for (const auto& message : hear())
      if (message.has_reply()) reply = message.reply();
    return reply;
  }
  joblink::Reply ask(joblink::ClientMessage message) {
    message.set_request_id(++requests_);
    say(message);
    const joblink::Reply reply = last_reply();
    EXPECT_EQ(reply.request_id(), requests_);
    return reply;
  }

  std::unique_ptr<ByteSession> stream;
  std::uint32_t session = 0, sequence = 0, heard_session = 0;

 private:
  LinkRig& rig_;
  joblink::FrameReader reader_;
  std::uint32_t requests_ = 0;
};

}  // namespace kinebus
