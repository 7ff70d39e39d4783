#include "gateway/jobs/store/notes/slicer_notes.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <system_error>

#include "protocol/joblink/shown_text.hpp"

namespace kinebus {
namespace {

using joblink::SlicerNotes;
using joblink::SlicerPicture;

/// Greater numbers are none of a job: 30 years, 1000 km.
constexpr double kMost = 1e9;
constexpr std::size_t kMaxWordBytes = 60;

std::string_view trimmed(std::string_view text) {
  const std::size_t first = std::min(text.find_first_not_of(" \t\r"), text.size());
  text.remove_prefix(first);
  return text.substr(0, text.find_last_not_of(" \t\r") + 1);
}

/// Takes the text up to `end` out of `rest`.
std::string_view taken(std::string_view& rest, char end) {
  const std::size_t at = std::min(rest.find(end), rest.size());
  const std::string_view front = rest.substr(0, at);
  rest.remove_prefix(std::min(at + 1, rest.size()));
  return front;
}

/// A number at the front of `text`, taken out; 0: none that could be meant.
double take_number(std::string_view& text) {
  double value = 0;
  const auto read = std::from_chars(text.data(), text.data() + text.size(), value);
  if (read.ec != std::errc()) return 0;
  text.remove_prefix(static_cast<std::size_t>(read.ptr - text.data()));
  return std::isfinite(value) && value > 0 && value <= kMost ? value : 0;
}

/// The whole of `text`, with its unit behind it.
double number_of(std::string_view text, std::string_view unit = {}) {
  text = trimmed(text);
  const double value = take_number(text);
  return text == unit ? value : 0;
}

/// "1.2, 3.4", one of each extruder. `scale`: what the unit is.
double sum_of(std::string_view text, std::string_view unit, double scale) {
  double sum = 0;
  while (!text.empty()) sum += number_of(taken(text, ','), unit) * scale;
  return sum <= kMost ? sum : 0;
}

/// "1d 2h 3m 4s"
double time_of(std::string_view text) {
  double sum = 0;
  for (text = trimmed(text); !text.empty();) {
    std::string_view part = taken(text, ' ');
    const double value = take_number(part);
    if (part == "d")
      sum += value * 86'400;
    else if (part == "h")
      sum += value * 3600;
    else if (part == "m")
      sum += value * 60;
    else if (part == "s")
      sum += value;
    else if (!part.empty())
      return 0;
  }
  return sum <= kMost ? sum : 0;
}

double first_of(std::string_view text) {
  return number_of(text.substr(0, text.find_first_of(",;")));
}
double plain_number(std::string_view text) {
  return number_of(text);
}
double sum_of_numbers(std::string_view text) {
  return sum_of(text, "", 1);
}
double sum_of_metres(std::string_view text) {
  return sum_of(text, "m", 1000);
}
/// "20m 3s; total estimated time: 26m 1s"
double total_time(std::string_view text) {
  static constexpr std::string_view kTotal = "total estimated time:";
  const std::size_t at = text.find(kTotal);
  return at == std::string_view::npos ? 0 : time_of(text.substr(at + kTotal.size()));
}

struct Fact {
  std::string_view key;
  double (*read)(std::string_view text);
  double (SlicerNotes::*present)() const;
  void (SlicerNotes::*set)(double value);
  bool greatest = false;  ///< of all that are there; else the first
};
constexpr std::array kFacts{
    // PrusaSlicer and what came of it
    Fact{"estimated printing time (normal mode)", time_of, &SlicerNotes::time_s, &SlicerNotes::set_time_s},
    Fact{"model printing time", total_time, &SlicerNotes::time_s, &SlicerNotes::set_time_s},
    Fact{"filament used [mm]", sum_of_numbers, &SlicerNotes::filament_mm, &SlicerNotes::set_filament_mm},
    Fact{"filament used [g]", sum_of_numbers, &SlicerNotes::filament_g, &SlicerNotes::set_filament_g},
    Fact{"total filament used [g]", plain_number, &SlicerNotes::filament_g, &SlicerNotes::set_filament_g},
    Fact{"layer_height", plain_number, &SlicerNotes::layer_mm, &SlicerNotes::set_layer_mm},
    Fact{"first_layer_height", plain_number, &SlicerNotes::first_layer_mm, &SlicerNotes::set_first_layer_mm},
    Fact{"initial_layer_print_height", plain_number, &SlicerNotes::first_layer_mm,
         &SlicerNotes::set_first_layer_mm},
    Fact{"nozzle_diameter", first_of, &SlicerNotes::nozzle_mm, &SlicerNotes::set_nozzle_mm},
    Fact{"first_layer_temperature", first_of, &SlicerNotes::first_layer_hotend_celsius,
         &SlicerNotes::set_first_layer_hotend_celsius},
    Fact{"nozzle_temperature_initial_layer", first_of, &SlicerNotes::first_layer_hotend_celsius,
         &SlicerNotes::set_first_layer_hotend_celsius},
    Fact{"first_layer_bed_temperature", first_of, &SlicerNotes::first_layer_bed_celsius,
         &SlicerNotes::set_first_layer_bed_celsius},
    Fact{"max_z_height", plain_number, &SlicerNotes::object_height_mm, &SlicerNotes::set_object_height_mm,
         true},
    // Of each layer.
    Fact{"Z", plain_number, &SlicerNotes::object_height_mm, &SlicerNotes::set_object_height_mm, true},
    // Cura
    Fact{"TIME", plain_number, &SlicerNotes::time_s, &SlicerNotes::set_time_s},
    Fact{"Filament used", sum_of_metres, &SlicerNotes::filament_mm, &SlicerNotes::set_filament_mm},
    Fact{"Layer height", plain_number, &SlicerNotes::layer_mm, &SlicerNotes::set_layer_mm},
    Fact{"MAXZ", plain_number, &SlicerNotes::object_height_mm, &SlicerNotes::set_object_height_mm, true},
};

/// "PrusaSlicer 2.9.4 on 2026-..."
bool take_generator(std::string_view said, SlicerNotes& notes) {
  static constexpr std::string_view kPrusa = "generated by ", kCura = "Generated with Cura_SteamEngine ",
                                    kBambu = "BambuStudio ";
  std::string_view name;
  if (said.starts_with(kPrusa)) {
    said.remove_prefix(kPrusa.size());
    name = taken(said, ' ');
  } else if (said.starts_with(kCura)) {
    said.remove_prefix(kCura.size());
    name = "Cura";
  } else if (said.starts_with(kBambu)) {
    said.remove_prefix(kBambu.size());
    name = "BambuStudio";
  }
  if (name.empty() || !notes.slicer().empty()) return !name.empty();
  notes.set_slicer(shown(name, kMaxWordBytes));
  notes.set_slicer_version(shown(taken(said, ' '), kMaxWordBytes));
  return true;
}

/// `said`: a comment without its mark.
void take_fact(std::string_view said, SlicerNotes& notes) {
  if (take_generator(said, notes)) return;
  const std::size_t at = said.find_first_of("=:");
  if (at == std::string_view::npos) return;
  const std::string_view key = trimmed(said.substr(0, at));
  const std::string_view value = trimmed(said.substr(at + 1));
  if (key == "filament_type" && notes.filament_type().empty())
    return notes.set_filament_type(shown(value, kMaxWordBytes));
  for (const Fact& fact : kFacts) {
    if (fact.key != key) continue;
    const double present = (notes.*fact.present)();
    const double read = fact.read(value);
    if (fact.greatest ? read > present : present == 0) (notes.*fact.set)(read);
  }
}

/// The blocks of pictures in a job's head, by their lines.
class Pictures {
 public:
  /// True: the line belongs to one. `said`: a comment without its mark, at `offset` in `head`; the next line
  /// is at `next`.
  bool take(std::string_view head, std::string_view said, std::size_t offset, std::size_t next,
            SlicerNotes& notes) {
    if (said.starts_with("thumbnail") && said.find(" begin ") != std::string_view::npos) {
      begin(said);
      picture_.set_text_offset_bytes(static_cast<std::uint32_t>(next));
      return true;
    }
    if (!within_) return false;
    const bool ends = said.starts_with("thumbnail") && said.ends_with(" end");
    within_ = !ends && said.find(' ') == std::string_view::npos;
    digits_ += within_ ? said.size() : 0;
    // Other words: a block that was never ended.
    if (!ends) return within_;
    const std::size_t from = picture_.text_offset_bytes();
    // A length that is not what is there: cut, or something else was put in.
    if (!wanted_ || digits_ != announced_ || notes.pictures_size() >= kMaxPictures) return true;
    const auto bytes = decode_picture(head.substr(from, offset - from), picture_);
    if (!bytes) return true;
    picture_.set_text_bytes(static_cast<std::uint32_t>(offset - from));
    picture_.set_size_bytes(static_cast<std::uint32_t>(bytes->size()));
    *notes.add_pictures() = picture_;
    return true;
  }

 private:
  /// "thumbnail begin 220x124 12345", "thumbnail_JPG begin ..."; other kinds are passed over.
  void begin(std::string_view said) {
    picture_.Clear();
    within_ = true;
    digits_ = 0;
    std::string_view kind = taken(said, ' ');
    kind.remove_prefix(std::string_view("thumbnail").size());
    picture_.set_jpeg(kind == "_JPG");
    taken(said, ' ');
    const double width = take_number(said);
    if (!said.empty()) said.remove_prefix(1);
    const double height = take_number(said);
    announced_ = static_cast<std::size_t>(number_of(said));
    wanted_ = (kind.empty() || kind == "_JPG" || kind == "_PNG") && width >= 1 && height >= 1 &&
              width <= kMaxPictureSidePx && height <= kMaxPictureSidePx;
    if (!wanted_) return;
    picture_.set_width_px(static_cast<std::uint32_t>(width));
    picture_.set_height_px(static_cast<std::uint32_t>(height));
  }

  SlicerPicture picture_;
  bool within_ = false, wanted_ = false;
  std::size_t announced_ = 0, digits_ = 0;  ///< of base64
};

/// Calls `take(said, offset, next)` with each comment that has a line of its own.
template <typename Take>
void each_comment(std::string_view text, Take take) {
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    const std::string_view line = text.substr(at, end - at);
    if (!line.empty() && line.front() == ';')
      take(trimmed(line.substr(1)), at, std::min(end + 1, text.size()));
    at = end + 1;
  }
}

}  // namespace

SlicerNotes read_slicer_notes(std::string_view head, std::string_view tail) {
  SlicerNotes notes;
  // A line that is cut says something else.
  if (!tail.empty()) {
    head = head.substr(0, head.rfind('\n') + 1);
    tail.remove_prefix(std::min(tail.find('\n'), tail.size()));
  }
  Pictures pictures;
  each_comment(head, [&](std::string_view said, std::size_t offset, std::size_t next) {
    if (!pictures.take(head, said, offset, next, notes)) take_fact(said, notes);
  });
  each_comment(tail, [&](std::string_view said, std::size_t, std::size_t) { take_fact(said, notes); });
  return notes;
}

}  // namespace kinebus
