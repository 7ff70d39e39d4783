#pragma once
// What slicers write into a job's comments: pictures of it, times, filament. PrusaSlicer, SuperSlicer and
// OrcaSlicer write pictures and generator at its beginning and the rest at its end, Cura all at its
// beginning. Nothing of it is believed: what does not hold is left out.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "protocol/joblink/kinebus.pb.h"

namespace kinebus {

/// So much of a job is looked at: its beginning, and its end where that is not within it.
inline constexpr std::size_t kNotesHeadBytes = 1U << 20, kNotesTailBytes = 512U << 10;
inline constexpr int kMaxPictures = 8;
inline constexpr std::uint32_t kMaxPictureSidePx = 2048;

/// `head`: from the job's first byte; `tail`: its last bytes, empty when all is in `head`.
joblink::SlicerNotes read_slicer_notes(std::string_view head, std::string_view tail);

/// The picture whose base64 stands in `text`, lines of a comment. nullopt: it is none, or not `picture`.
std::optional<std::string> decode_picture(std::string_view text, const joblink::SlicerPicture& picture);

}  // namespace kinebus
