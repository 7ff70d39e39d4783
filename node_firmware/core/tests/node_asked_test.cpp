// Nothing ticks: a node that is called at its deadlines alone, and one that is called all the time, move and
// tell the same, to the bit and at the same nanosecond.

#include "node_firmware/core/tests/node_bench.hpp"

namespace kinebus::testing_bench {
namespace {

struct Told {
  LocalTime at{0};
  std::string frame;
  bool operator==(const Told&) const = default;
};

struct Called {
  Called() : node({.node_id = 1}, LocalTime{1s}) { pull(LocalTime{1s}); }
  void on_time(LocalTime t) {
    node.on_time(t);
    pull(t);
  }
  void on_frame(LocalTime t, const CanFrame& frame) {
    node.on_frame(t, frame);
    pull(t);
  }
  void pull(LocalTime t) {
    while (const auto frame = node.next_frame()) told.push_back({t, text_of(*frame)});
  }
  LoneNode node;
  std::vector<Told> told;
};

CanFrame writing(int index, int sub, int size, std::int64_t value) {
  CanFrame request{.id = 0x601, .length = 8};
  request.data[0] = static_cast<std::uint8_t>(0x23 | ((4 - size) << 2));
  put_u16_le(std::span(request.data).subspan(1), static_cast<std::uint16_t>(index));
  request.data[3] = static_cast<std::uint8_t>(sub);
  put_le(std::span(request.data).subspan(4), static_cast<std::uint32_t>(value));
  return request;
}

class AskedTest : public testing::TestWithParam<int> {
 protected:
  AskedTest() : random_(static_cast<unsigned>(GetParam())) {}
  std::uint64_t of(std::uint64_t n) { return random_() % n; }

  void until(LocalTime end) {
    for (;;) {
      const LocalTime deadline = std::max(seldom_.node.next_deadline(), now_ + 1ns), grid = now_ + kGrid;
      const LocalTime next = std::min({deadline, grid_, end});
      if (next == grid_) grid_ = grid;
      now_ = next;
      if (next == deadline) seldom_.on_time(next);
      often_.on_time(next);
      if (next >= end) break;
    }
    for (const int axis : {0, 1})
      ASSERT_EQ(seldom_.node.position(now_, axis), often_.node.position(now_, axis)) << now_.count();
    compare();
  }
  void compare() {
    ASSERT_EQ(seldom_.told.size(), often_.told.size()) << now_.count();
    for (std::size_t i = 0; i < seldom_.told.size(); ++i) {
      ASSERT_EQ(seldom_.told[i].frame, often_.told[i].frame) << now_.count();
      ASSERT_EQ(seldom_.told[i].at, often_.told[i].at) << seldom_.told[i].frame;
    }
    seldom_.told.clear();
    often_.told.clear();
  }
  void send(const CanFrame& frame) {
    until(now_ + 300us);
    if (HasFatalFailure()) return;
    seldom_.on_frame(now_, frame);
    often_.on_frame(now_, frame);
    compare();
  }
  void write(int index, int sub, int size, std::int64_t value, int axis = 0) {
    send(writing(index + axis * 0x800, sub, size, value));
  }
  void input(int which, bool level) {
    seldom_.node.on_switch(now_, which, level);
    often_.node.on_switch(now_, which, level);
    seldom_.pull(now_);
    often_.pull(now_);
    compare();
  }
  void enable(int axis) {
    for (const int word : {0x06, 0x07, 0x0F}) write(0x6040, 0, 2, word, axis);
  }
  void anything();

  static constexpr LocalTime kGrid = 211us;
  std::mt19937_64 random_;
  Called seldom_, often_;
  LocalTime now_{1s}, grid_{1s};
  int mode_[2] = {1, 1};
};

void AskedTest::anything() {
  const int axis = static_cast<int>(of(2));
  const auto place = static_cast<std::int64_t>(of(20'000)) - 10'000;
  switch (of(14)) {
    case 0:
      mode_[axis] = std::array{1, 3, 6, 8, 7}[of(5)];
      write(0x6060, 0, 1, mode_[axis], axis);
      break;
    case 1:
    case 2:
    case 3:
      write(0x607A, 0, 4, place, axis);
      write(0x6040, 0, 2, 0x0F, axis);
      write(0x6040, 0, 2, 0x1F | (of(2) << 5) | (of(2) << 6) | (of(2) << 9), axis);
      break;
    case 4:
      write(0x60FF, 0, 4, of(3) == 0 ? 0 : place * 4, axis);
      break;
    case 5:
      write(0x6040, 0, 2, 0x10F | (of(2) << 4), axis);  // halt
      break;
    case 6:
      write(0x6040, 0, 2, std::array{0x02, 0x06, 0x07, 0x00}[of(4)], axis);
      break;
    case 7:
      enable(axis);
      break;
    case 8:
      input(static_cast<int>(of(3)), of(2) == 0);
      break;
    case 9:
    case 10:
      for (std::uint64_t i = of(20); i > 0; --i) {
        write(0x60C1, 1, 4, place / 20 * static_cast<std::int64_t>(i), axis);
        write(0x607A, 0, 4, place / 20 * static_cast<std::int64_t>(i), axis);
        until(now_ + 9ms);
        if (HasFatalFailure()) return;
        send(CanFrame{.id = 0x80, .length = 0});
      }
      break;
    case 11:
      write(0x6040, 0, 2, 0x80, axis);
      enable(axis);
      break;
    case 12:
      write(0x6098, 0, 1, std::array{35, 17, 18, 19, 20, 21, 22}[of(7)], axis);
      break;
    default:
      write(0x6083 + static_cast<int>(of(2)), 0, 4, 20'000 + static_cast<std::int64_t>(of(1'000'000)), axis);
      break;
  }
}

TEST_P(AskedTest, OftenOrSeldomItMovesAndTellsTheSame) {
  send(frame_of("000#0101"));
  write(0x1017, 0, 2, 37);
  write(0x60C2, 1, 1, 10);
  write(0x60C2, 1, 1, 10, 1);
  for (const int axis : {0, 1}) {
    write(0x60C0, 0, 2, 0, axis);
    write(0x6060, 0, 1, 1, axis);
    write(0x6065, 0, 4, static_cast<std::int64_t>(of(2) * 0xFFFF'FFFF), axis);
    enable(axis);
  }
  for (int i = 0; i < 60; ++i) {
    until(now_ + LocalTime{static_cast<std::int64_t>(of(120'000'000))});
    if (HasFatalFailure()) return;
    anything();
    if (HasFatalFailure()) return;
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, AskedTest, testing::Range(1, 41));

/// A set-point that waits begins where and when the one before it ends, whoever looks first.
TEST(NodeAsked, APlaceIsTheSameWhetherTimeWasToldBeforeOrNot) {
  Called told, asked;
  const auto both = [&](LocalTime t, const CanFrame& frame) {
    told.on_frame(t, frame);
    asked.on_frame(t, frame);
  };
  LocalTime t{1s};
  const auto write = [&](int index, int size, std::int64_t value) {
    both(t += 1ms, writing(index, 0, size, value));
  };
  write(0x6060, 1, 1);
  for (const int word : {0x06, 0x07, 0x0F}) write(0x6040, 2, word);
  for (const int target : {3'000, -2'000}) {
    write(0x607A, 4, target);
    write(0x6040, 2, 0x0F);
    write(0x6040, 2, 0x1F);
  }
  bool turned = false;
  for (int i = 0; i < 500; ++i) {
    t += 1ms;
    while (told.node.next_deadline() <= t) told.on_time(told.node.next_deadline());
    EXPECT_EQ(asked.node.position(t, 0), told.node.position(t, 0)) << i;
    turned = turned || told.node.position(t, 0) < 0;
  }
  EXPECT_TRUE(turned);
  EXPECT_EQ(asked.node.position(t, 0), from_counts(-2'000));
}

/// And where it will be, if nothing more comes, is where it then is.
TEST(NodeAsked, WhatIsSeenAheadComes) {
  for (unsigned seed = 1; seed <= 40; ++seed) {
    std::mt19937_64 random(seed);
    const auto of = [&](std::uint64_t n) { return static_cast<std::int64_t>(random() % n); };
    Called one;
    LocalTime t{1s};
    const auto write = [&](int index, int sub, int size, std::int64_t value) {
      one.on_frame(t += 200us, writing(index, sub, size, value));
    };
    const auto wait = [&](LocalTime span) {
      const LocalTime end = t + span;
      while (one.node.next_deadline() <= end) one.on_time(one.node.next_deadline());
      one.on_time(t = end);
    };
    // Zero is not where the motor began.
    write(0x607C, 0, 4, of(1000) - 500);
    write(0x6098, 0, 1, 35);
    write(0x6060, 0, 1, 6);
    for (const int word : {0x06, 0x07, 0x0F, 0x1F}) write(0x6040, 0, 2, word);
    wait(20ms);
    write(0x6060, 0, 1, 1);
    wait(2ms);
    for (int i = 0; i < 12; ++i) {
      write(0x6083, 0, 4, 100'000 + of(1'000'000));
      write(0x607A, 0, 4, of(8'000) - 4'000);
      write(0x6040, 0, 2, 0x0F);
      write(0x6040, 0, 2, 0x1F | (of(2) << 5));
      write(0x607A, 0, 4, of(8'000) - 4'000);
      write(0x6040, 0, 2, 0x0F);
      write(0x6040, 0, 2, 0x1F | (of(2) << 9));
      // Just before it passes a place, or stands there.
      if (one.node.next_deadline() != LocalTime::max() && one.node.next_deadline() > t + 3ms && of(3) != 0)
        wait(one.node.next_deadline() - t - 1'500us);
      NodePreview preview(one.node);
      const LocalTime from = t, deadline = one.node.next_deadline();
      std::vector<std::int64_t> ahead;
      for (int k = 0; k < 8; ++k) ahead.push_back(preview.positions(from + k * 500us)[0]);
      for (int k = 0; k < 8; ++k) {
        const LocalTime when = from + k * 500us;
        // Behind the deadline it is not known what comes, but for the speed.
        const double late = std::chrono::duration<double>(std::max(when - deadline, LocalTime{0})).count();
        const double off =
            static_cast<double>(one.node.position(when, 0) - ahead[static_cast<std::size_t>(k)]);
        ASSERT_LE(std::abs(off), std::ldexp(2.2e6 * late * late, 32)) << seed << " " << i << " " << k;
      }
      t = from + 4ms;
      wait(LocalTime{of(100'000'000)});
    }
  }
}

}  // namespace
}  // namespace kinebus::testing_bench
