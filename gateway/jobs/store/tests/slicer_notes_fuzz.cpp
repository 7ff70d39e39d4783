// Any bytes as a job's beginning and end: nothing may crash, and what is found is within its bounds.

#include <cmath>
#include <cstdlib>
#include <string_view>

#include "gateway/jobs/store/notes/slicer_notes.hpp"
#include "protocol/joblink/shown_text.hpp"

namespace {
void check(bool holds) {
  if (!holds) std::abort();
}
void look_at(std::string_view head, std::string_view tail) {
  const auto notes = kinebus::read_slicer_notes(head, tail);
  check(notes.pictures_size() <= kinebus::kMaxPictures);
  for (const auto& picture : notes.pictures()) {
    check(picture.text_offset_bytes() <= head.size());
    check(picture.text_bytes() <= head.size() - picture.text_offset_bytes());
    const auto bytes =
        kinebus::decode_picture(head.substr(picture.text_offset_bytes(), picture.text_bytes()), picture);
    check(bytes && bytes->size() == picture.size_bytes());
    check(picture.width_px() <= kinebus::kMaxPictureSidePx &&
          picture.height_px() <= kinebus::kMaxPictureSidePx);
  }
  for (const double value : {notes.time_s(), notes.filament_mm(), notes.filament_g(), notes.layer_mm(),
                             notes.first_layer_mm(), notes.object_height_mm(), notes.nozzle_mm(),
                             notes.first_layer_hotend_celsius(), notes.first_layer_bed_celsius()})
    check(std::isfinite(value) && value >= 0 && value <= 1e9);
  for (const auto& text : {notes.slicer(), notes.slicer_version(), notes.filament_type()})
    check(kinebus::is_plain(text));
}
}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  look_at(text, {});
  look_at(text.substr(0, size / 2), text.substr(size / 2));
  return 0;
}
