#pragma once
// The gateway's end of a job link to a simulated gateway.

#include "gateway/sessions/byte_session.hpp"
#include "protocol/joblink/frame_codec.hpp"
#include "vcan_tests/fleet/gateways/simulated_gateway.hpp"

namespace kinebus::fleet {

class LinkSession : public ByteSession {
 public:
  explicit LinkSession(SimulatedGateway& gateway) : gateway_(gateway) {}
  void on_bytes(LocalTime now, std::span<const std::uint8_t> bytes) override;
  void on_time(LocalTime) override {}
  LocalTime next_deadline() const override { return LocalTime::max(); }
  std::span<const std::uint8_t> next_bytes() override { return out_.bytes(); }
  void on_bytes_sent(std::size_t count) override { out_.sent(count); }
  bool ended() const override { return false; }
  void on_closed(LocalTime, std::string_view) override {}

 private:
  void take(LocalTime now, const joblink::FrameView& frame);
  void send(joblink::Reply reply, std::uint32_t request);

  SimulatedGateway& gateway_;
  joblink::FrameReader reader_;
  joblink::FrameQueue out_;
  std::uint32_t session_ = 0, sequence_ = 0;
};

}  // namespace kinebus::fleet
