// The frame stream over real sockets, and what joins two ports.
#include "vcan_tests/can_port/can_port.hpp"

#include <gtest/gtest.h>
#include <linux/can.h>
#include <sys/socket.h>
#include <unistd.h>

#include <filesystem>
#include <vector>

#include "protocol/host/kernel_frame.hpp"

namespace kinebus {
namespace {

struct Pair {
  Pair() { EXPECT_EQ(::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends), 0); }
  int ends[2]{-1, -1};
};

CanFrame numbered(std::uint32_t n) {
  return CanFrame::make(n % 0x800, {static_cast<std::uint8_t>(n), static_cast<std::uint8_t>(n >> 8), 3});
}

std::vector<CanFrame> all_of(CanPort& port) {
  std::vector<CanFrame> frames;
  while (const auto got = port.receive()) frames.push_back(got->frame);
  return frames;
}

TEST(StreamPort, EveryKindOfFrameArrivesAsItWasSent) {
  Pair pair;
  StreamPort a(pair.ends[0]), b(pair.ends[1]);
  std::vector<CanFrame> frames = {CanFrame::make(0x7FF, {}), CanFrame::make(0, {1, 2, 3, 4, 5, 6, 7, 8})};
  frames.push_back({.id = 0x1FFFFFFF, .extended = true, .length = 1, .data = {9}});
  frames.push_back({.id = 0x701, .remote = true, .length = 1});
  for (const CanFrame& frame : frames) EXPECT_TRUE(a.send(frame));
  EXPECT_TRUE(all_of(b).empty()) << "nothing leaves before it is flushed";
  a.flush();
  EXPECT_EQ(all_of(b), frames);
}

TEST(StreamPort, AFrameIsOneHoweverItsBytesCome) {
  Pair pair;
  StreamPort port(pair.ends[0]);
  std::vector<std::uint8_t> bytes;
  std::vector<CanFrame> frames, got;
  for (std::uint32_t n = 0; n < 300; ++n) {
    frames.push_back(numbered(n));
    const can_frame raw = to_kernel(frames.back());
    const auto* first = reinterpret_cast<const std::uint8_t*>(&raw);
    bytes.insert(bytes.end(), first, first + sizeof raw);
  }
  for (std::size_t at = 0, piece = 1; at < bytes.size(); at += piece, piece = piece % 37 + 1) {
    piece = std::min(piece, bytes.size() - at);
    ASSERT_EQ(::write(pair.ends[1], bytes.data() + at, piece), static_cast<ssize_t>(piece));
    for (const CanFrame& frame : all_of(port)) got.push_back(frame);
    EXPECT_EQ(got.size(), (at + piece) / 16);
  }
  EXPECT_EQ(got, frames);
  EXPECT_FALSE(port.closed());
  ::close(pair.ends[1]);
}

TEST(StreamPort, APeerThatEndsBetweenFramesIsNoTrouble) {
  Pair pair;
  StreamPort port(pair.ends[0]);
  {
    StreamPort peer(pair.ends[1]);
    peer.send(numbered(1));
    peer.flush();
  }
  EXPECT_EQ(all_of(port), std::vector{numbered(1)});
  EXPECT_TRUE(port.closed());
  EXPECT_EQ(port.trouble(), "");
  EXPECT_FALSE(port.send(numbered(2)));
}

TEST(StreamPort, WritingToAPeerThatIsGoneClosesIt) {
  Pair pair;
  StreamPort port(pair.ends[0]);
  ::close(pair.ends[1]);
  EXPECT_TRUE(port.send(numbered(1)));
  port.flush();
  EXPECT_TRUE(port.closed());
  EXPECT_EQ(port.trouble(), "");
}

TEST(StreamPort, AFrameCutShortIsTold) {
  Pair pair;
  StreamPort port(pair.ends[0]);
  ASSERT_EQ(::write(pair.ends[1], "0123456", 7), 7);
  EXPECT_TRUE(all_of(port).empty());
  EXPECT_FALSE(port.closed());
  ::close(pair.ends[1]);
  EXPECT_TRUE(all_of(port).empty());
  EXPECT_TRUE(port.closed());
  EXPECT_NE(port.trouble().find("within a frame"), std::string::npos) << port.trouble();
}

TEST(StreamPort, WhatIsNoFrameIsTold) {
  for (const bool error_frame : {false, true}) {
    Pair pair;
    StreamPort port(pair.ends[0]);
    can_frame raw{};
    raw.can_dlc = error_frame ? 8 : 9;
    raw.can_id = error_frame ? CAN_ERR_FLAG : 0x123;
    ASSERT_EQ(::write(pair.ends[1], &raw, sizeof raw), static_cast<ssize_t>(sizeof raw));
    EXPECT_TRUE(all_of(port).empty());
    EXPECT_TRUE(port.closed());
    EXPECT_NE(port.trouble().find("no frame"), std::string::npos) << port.trouble();
    ::close(pair.ends[1]);
  }
}

TEST(StreamPort, AFullStreamRefusesAndLosesNothing) {
  Pair pair;
  StreamPort a(pair.ends[0]), b(pair.ends[1]);
  std::uint32_t sent = 0;
  while (a.send(numbered(sent))) ASSERT_LT(++sent, 10'000'000u);
  EXPECT_NE(a.waits_for(false).events & POLLOUT, 0);
  std::uint32_t got = 0;
  for (const std::uint32_t end = sent + 1000; got < end;) {
    for (const CanFrame& frame : all_of(b)) ASSERT_EQ(frame, numbered(got++));
    while (sent < end && a.send(numbered(sent))) ++sent;
    a.flush();
  }
  EXPECT_EQ(a.waits_for(true).events, POLLIN);
}

TEST(OneWay, HoldsOneFrameBackWhenThereIsNoRoomAndFetchesNoMore) {
  Pair left, right;
  StreamPort source(left.ends[0]), from(left.ends[1]), to(right.ends[0]), sink(right.ends[1]);
  OneWay way;
  std::uint32_t sent = 0, got = 0;
  // The far side does not read: after a while the near side is full, too.
  for (int quiet = 0; quiet < 3; ++quiet) {
    while (source.send(numbered(sent))) ++sent, quiet = 0;
    source.flush();
    way.pass(from, to);
  }
  EXPECT_TRUE(way.waits());
  EXPECT_FALSE(source.send(numbered(sent)));
  while (got < sent) {
    for (const CanFrame& frame : all_of(sink)) ASSERT_EQ(frame, numbered(got++));
    source.flush();
    way.pass(from, to);
  }
  EXPECT_FALSE(way.waits());
}

TEST(StreamPort, MeetsAtAUnixSocket) {
  std::string folder = (std::filesystem::temp_directory_path() / "kinebus-port.XXXXXX").string();
  ASSERT_NE(::mkdtemp(folder.data()), nullptr);
  const std::string path = folder + "/bus";
  StreamPort listener, other;
  EXPECT_NE(other.open(path).find("No such file"), std::string::npos);
  ASSERT_EQ(listener.listen_at(path), "");
  EXPECT_EQ(other.open(path), "");
  EXPECT_EQ(listener.wait(), "");
  ASSERT_TRUE(other.send(numbered(5)));
  other.flush();
  EXPECT_EQ(all_of(listener), std::vector{numbered(5)});
  EXPECT_NE(StreamPort().listen_at(folder + "/none/bus").find("cannot be made"), std::string::npos);
  EXPECT_NE(StreamPort().listen_at(std::string(200, 'x')).find("103"), std::string::npos);
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace kinebus
