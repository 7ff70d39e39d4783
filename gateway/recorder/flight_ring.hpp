#pragma once
// The flight recorder's memory: the last minute of frames, samples and events, in plain fixed-size rows. It
// may lie in a file that is mapped into memory: then it survives the process that wrote it.

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <cstring>
#include <string_view>
#include <type_traits>

#include "protocol/can/frame.hpp"
#include "protocol/time.hpp"

namespace kinebus {

/// All members are plain values; a zeroed one is empty. Writing costs no allocation and no call of the
/// system.
struct FlightRing {
  static constexpr std::uint64_t kMagic = 0x32'66'6C'69'67'68'74'4B;  ///< changes with the layout
  static constexpr std::size_t kFrames = 1 << 18;                     ///< 60 s of 4300 frames/s
  static constexpr std::size_t kSamples = 1 << 10;                    ///< 100 s, 10 a second
  static constexpr std::size_t kEvents = 1 << 8;
  static constexpr std::size_t kJoints = 8;
  static constexpr std::chrono::milliseconds kSamplePeriod{100};

  struct Frame {
    std::int64_t when_ns;
    std::uint32_t id;
    std::uint8_t length, flags;  ///< 1: extended, 2: remote, 4: sent by the gateway
    std::array<std::uint8_t, 2> unused;
    std::array<std::uint8_t, 8> data;
  };
  struct Sample {
    std::int64_t when_ns;
    double path_time_s, rate, progress;
    std::array<double, kJoints> joints;  ///< mm or rad
    /// Measured by encoders; a joint without one: as commanded.
    std::array<double, kJoints> measured;
    std::array<double, 6> pose;  ///< tool, machine frame
    std::uint32_t line;
    std::uint16_t sync_error_us;  ///< the worst node's bound
    std::uint8_t state, joint_count, positions_known;
  };
  struct Event {
    std::int64_t when_ns;
    std::uint32_t line;
    std::uint16_t code;
    std::uint8_t kind, state, node;
    std::array<char, 160> words, advice;
  };

  std::uint64_t magic;
  std::uint64_t running;        ///< 1 while a gateway writes; still 1 when it died
  std::int64_t unix_offset_ns;  ///< added to the times: since 1970
  std::array<char, 64> machine, job;
  std::uint64_t frame_count, sample_count, event_count;
  std::array<Frame, kFrames> frames;
  std::array<Sample, kSamples> samples;
  std::array<Event, kEvents> events;

  void add_frame(BusTime when, const CanFrame& frame, bool own) {
    Frame& row = frames[frame_count % kFrames];
    row.when_ns = when.count();
    row.id = frame.id;
    row.length = frame.length;
    row.flags = static_cast<std::uint8_t>((frame.extended ? 1 : 0) | (frame.remote ? 2 : 0) | (own ? 4 : 0));
    row.data = frame.data;
    ++frame_count;
  }
  Sample& next_sample() { return samples[sample_count++ % kSamples]; }
  Event& next_event() {
    Event& row = events[event_count++ % kEvents];
    row = Event{};
    return row;
  }
  /// Cut to what fits, always ended by 0.
  template <std::size_t N>
  static void put(std::array<char, N>& text, std::string_view value) {
    text.fill(0);
    std::memcpy(text.data(), value.data(), std::min(value.size(), N - 1));
  }
  template <std::size_t N>
  static std::string_view get(const std::array<char, N>& text) {
    return {text.data(), static_cast<std::size_t>(std::find(text.begin(), text.end(), '\0') - text.begin())};
  }
  /// Rows from the oldest kept to the newest.
  template <typename Rows, typename Visit>
  static void each(const Rows& rows, std::uint64_t count, Visit visit) {
    const std::uint64_t first = count > rows.size() ? count - rows.size() : 0;
    for (std::uint64_t i = first; i < count; ++i) visit(rows[i % rows.size()]);
  }
};
static_assert(std::is_trivially_copyable_v<FlightRing>);

}  // namespace kinebus
