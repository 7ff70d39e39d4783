#include "gateway/jobs/journal/journal_codec.hpp"

#include <libdeflate.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>
#include <string_view>
#include <type_traits>

#include "protocol/joblink/shown_text.hpp"

namespace kinebus::journal {
namespace {

constexpr std::uint8_t kMagic = 0x4B;
constexpr std::size_t kHeader = 8, kTrailer = 4, kMaxName = 1000;

std::uint32_t crc_of(std::span<const std::uint8_t> bytes) {
  return ::libdeflate_crc32(0, bytes.data(), bytes.size());
}

/// One list of fields for both directions, so that they cannot differ.
template <class Io>
void fields(Io& io, Epoch& r) {
  io.u8(r.epoch);
}
template <class Io>
void fields(Io& io, JobBegin& r) {
  io.u64(r.bytes);
  io.u64(r.hash);
  for (double& value : r.start) io.f64(value);
  io.text(r.name);
  for (auto& system : r.offsets)
    for (double& value : system) io.f64(value);
}
template <class Io>
void fields(Io& io, JobPlace& r) {
  io.u64(r.phase);
  io.f64(r.phase_s);
}
template <class Io>
void fields(Io& io, RunBegin& r) {
  io.time(r.start);
  fields(io, r.from);
  io.f64(r.ramp_s);
  io.f64(r.extruder_shift_mm);
}
template <class Io>
void fields(Io& io, WaitsDone& r) {
  io.u64(r.count);
}
template <class Io>
void fields(Io& io, Scale& r) {
  io.u64(r.scale.move);
  io.f64(r.scale.scale);
}
template <class Io>
void fields(Io& io, Override& r) {
  io.f64(r.ratio);
}
template <class Io>
void fields(Io& io, Thermal& r) {
  io.f64(r.hotend_celsius);
  io.f64(r.bed_celsius);
  io.f64(r.fan);
  io.f64(r.spindle_rpm);
}
template <class Io>
void fields(Io& io, Progress& r) {
  io.time(r.tau);
  io.u32(r.line);
  for (double& value : r.joints) io.f64(value);
}
template <class Io>
void fields(Io& io, Interrupted& r) {
  fields(io, r.place);
  io.f64(r.extruder_shift_mm);
}
template <class Io>
void fields(Io& io, Found& r) {
  io.time(r.tau);
}
template <class Io>
void fields(Io&, JobEnd&) {}
template <class Io>
void fields(Io& io, Offsets& r) {
  io.text(r.machine);
  for (auto& system : r.offsets)
    for (double& value : system) io.f64(value);
}

template <class Io>
void fields(Io& io, Heat& r) {
  io.f64(r.spindle_rpm);
  io.stated(r.targets);
}

template <class Io>
void fields(Io& io, JobTime& r) {
  io.u32(r.line);
  io.f64(r.elapsed_s);
  io.f64(r.done_s);
  io.f64(r.motion_s);
}

template <class Io>
void fields(Io& io, MeshGrid& r) {
  for (std::size_t axis = 0; axis < 2; ++axis) {
    io.count(r.points[axis]);
    io.f64(r.from_mm[axis]);
    io.f64(r.to_mm[axis]);
  }
  io.f64(r.fade_mm);
  io.heights(r.height_mm);
}
template <class Io>
void fields(Io& io, Learned& r) {
  io.choice(r.what, Learned::What::kInput);
  io.u64(r.phases);
  io.flag(r.contact);
  io.choice(r.frame, Frame::kMachine);
  for (double& value : r.at) io.f64(value);
  for (double& value : r.stand) io.f64(value);
  fields(io, r.mesh);
}
template <class Io>
void fields(Io& io, Mesh& r) {
  io.text(r.machine);
  io.u64(r.geometry);
  io.text(r.name);
  io.f64(r.unix_s);
  fields(io, r.grid);
}
template <class Io>
void fields(Io& io, MeshInForce& r) {
  io.text(r.machine);
  io.text(r.name);
}

template <class Io>
void fields(Io& io, ObjectLeftOut& r) {
  io.u64(r.object.step);
  io.text(r.object.name);
}

template <class Io>
void fields(Io& io, Printed& r) {
  io.f64(r.top_mm);
}

struct Writer {
  std::vector<std::uint8_t>& out;
  void bits(std::uint64_t value, int bytes) {
    for (int i = 0; i < bytes; ++i) out.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
  }
  void u8(std::uint8_t value) { bits(value, 1); }
  void u32(std::uint32_t value) { bits(value, 4); }
  void u64(std::uint64_t value) { bits(value, 8); }
  void f64(double value) { bits(std::bit_cast<std::uint64_t>(value), 8); }
  void time(PathTime value) { bits(static_cast<std::uint64_t>(value.count()), 8); }
  void count(int value) { u8(static_cast<std::uint8_t>(value)); }
  void flag(bool value) { u8(value ? 1 : 0); }
  template <class E>
  void choice(E value, E /*last*/) {
    u8(static_cast<std::uint8_t>(value));
  }
  void heights(const std::vector<float>& values) {
    bits(values.size(), 2);
    for (const float value : values) bits(std::bit_cast<std::uint32_t>(value), 4);
  }
  /// Those that are not 0, each with its number.
  void stated(std::span<const double> values) {
    const auto is_stated = [](double value) { return value != 0; };
    u8(static_cast<std::uint8_t>(std::count_if(values.begin(), values.end(), is_stated)));
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (!is_stated(values[i])) continue;
      u8(static_cast<std::uint8_t>(i));
      f64(values[i]);
    }
  }
  void text(const std::string& value) {
    const std::string_view kept = cut_text(value, kMaxName);
    bits(kept.size(), 2);
    out.insert(out.end(), kept.begin(), kept.end());
  }
};

struct Reader {
  std::span<const std::uint8_t> in;
  bool good = true;
  std::uint64_t bits(std::size_t bytes) {
    if (in.size() < bytes) {
      good = false;
      return 0;
    }
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < bytes; ++i) value |= std::uint64_t{in[i]} << (8 * i);
    in = in.subspan(bytes);
    return value;
  }
  void u8(std::uint8_t& value) { value = static_cast<std::uint8_t>(bits(1)); }
  void u32(std::uint32_t& value) { value = static_cast<std::uint32_t>(bits(4)); }
  void u64(std::uint64_t& value) { value = bits(8); }
  void f64(double& value) {
    value = std::bit_cast<double>(bits(8));
    good = good && std::isfinite(value);
  }
  void time(PathTime& value) { value = PathTime{static_cast<std::int64_t>(bits(8))}; }
  void count(int& value) { value = static_cast<int>(bits(1)); }
  void flag(bool& value) { value = bits(1) != 0; }
  template <class E>
  void choice(E& value, E last) {
    const std::uint64_t read = bits(1);
    good = good && read <= static_cast<std::uint64_t>(last);
    if (good) value = static_cast<E>(read);
  }
  void heights(std::vector<float>& values) {
    constexpr std::size_t kMost = std::size_t{MeshGrid::kMostPoints} * MeshGrid::kMostPoints;
    const auto size = static_cast<std::size_t>(bits(2));
    good = good && size <= kMost && size * 4 <= in.size();
    if (!good) return;
    values.resize(size);
    for (float& value : values) {
      value = std::bit_cast<float>(static_cast<std::uint32_t>(bits(4)));
      good = good && std::isfinite(value);
    }
  }
  void stated(std::span<double> values) {
    std::uint8_t count = 0, number = 0;
    for (u8(count); count > 0 && good; --count) {
      double value = 0;
      u8(number);
      f64(value);
      good = good && number < values.size();
      if (good) values[number] = value;
    }
  }
  void text(std::string& value) {
    const std::size_t length = static_cast<std::size_t>(bits(2));
    if (length > kMaxName || length > in.size()) {
      good = false;
      return;
    }
    value.assign(in.begin(), in.begin() + static_cast<std::ptrdiff_t>(length));
    in = in.subspan(length);
  }
};

template <std::size_t... I>
std::optional<Record> read_kind(std::size_t kind, Reader& reader, std::index_sequence<I...>) {
  std::optional<Record> record;
  const auto read = [&]<std::size_t N>() {
    if (kind != N) return;
    std::variant_alternative_t<N, Record> value;
    fields(reader, value);
    record.emplace(std::move(value));
  };
  (read.template operator()<I>(), ...);
  return reader.good && reader.in.empty() ? record : std::nullopt;
}

}  // namespace

void encode(const Record& record, std::uint32_t number, std::vector<std::uint8_t>& out) {
  const std::size_t begin = out.size();
  Writer writer{out};
  writer.u8(kMagic);
  writer.u8(static_cast<std::uint8_t>(record.index()));
  writer.bits(0, 2);
  writer.u32(number);
  Record copy = record;
  std::visit([&](auto& value) { fields(writer, value); }, copy);
  const std::size_t length = out.size() - begin - kHeader;
  out[begin + 2] = static_cast<std::uint8_t>(length);
  out[begin + 3] = static_cast<std::uint8_t>(length >> 8);
  writer.u32(crc_of(std::span(out).subspan(begin)));
}

Decoded decode(std::span<const std::uint8_t> bytes) {
  Decoded result;
  for (;;) {
    const auto rest = bytes.subspan(result.bytes);
    if (rest.size() < kHeader + kTrailer || rest[0] != kMagic) return result;
    const std::size_t length = rest[2] | (std::size_t{rest[3]} << 8), whole = kHeader + length + kTrailer;
    if (whole > kMaxRecordBytes || rest.size() < whole) return result;
    Reader head{rest.subspan(4, 4)}, trailer{rest.subspan(kHeader + length, kTrailer)};
    if (trailer.bits(4) != crc_of(rest.first(kHeader + length)) || head.bits(4) != result.records)
      return result;
    Reader payload{rest.subspan(kHeader, length)};
    const auto record = read_kind(rest[1], payload, std::make_index_sequence<std::variant_size_v<Record>>{});
    if (!record) return result;
    result.state.take(*record);
    ++result.records;
    result.bytes += whole;
  }
}

}  // namespace kinebus::journal
