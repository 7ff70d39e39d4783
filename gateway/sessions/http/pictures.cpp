#include "gateway/sessions/http/pictures.hpp"

#include <optional>
#include <utility>

namespace kinebus::http {
namespace {

/// PrusaSlicer's icons have 16.
constexpr std::uint32_t kLeastInLists = 32;

std::uint32_t area_of(const joblink::SlicerPicture& picture) {
  return picture.width_px() * picture.height_px();
}

struct Sent {
  std::string bytes;
  const char* type = "image/png";
  std::string mark;
};

std::optional<Sent> picture_of(JobStore& store, const std::vector<std::string>& names,
                               const ChoosePicture& choose) {
  for (const std::string& name : names) {
    const auto job = store.find(name);
    if (!job) continue;
    const joblink::SlicerPicture* picture = choose(job->notes);
    auto bytes = picture != nullptr ? store.picture(*job, *picture) : std::nullopt;
    if (!bytes) return std::nullopt;
    std::string mark = std::to_string(picture->text_offset_bytes()) + "-";
    static constexpr std::string_view kDigits = "0123456789abcdef";
    for (const char c : job->hash) {
      const auto byte = static_cast<unsigned char>(c);
      mark += kDigits[byte >> 4U];
      mark += kDigits[byte & 15U];
    }
    return Sent{std::move(*bytes), picture->jpeg() ? "image/jpeg" : "image/png", std::move(mark)};
  }
  return std::nullopt;
}

}  // namespace

const joblink::SlicerPicture* great_picture(const joblink::SlicerNotes& notes) {
  const joblink::SlicerPicture* found = nullptr;
  for (const auto& picture : notes.pictures())
    if (found == nullptr || area_of(picture) > area_of(*found)) found = &picture;
  return found;
}

const joblink::SlicerPicture* small_picture(const joblink::SlicerNotes& notes) {
  const joblink::SlicerPicture* found = nullptr;
  for (const auto& picture : notes.pictures()) {
    const bool fits = picture.width_px() >= kLeastInLists && picture.height_px() >= kLeastInLists;
    if (fits && (found == nullptr || area_of(picture) < area_of(*found))) found = &picture;
  }
  return found != nullptr ? found : great_picture(notes);
}

void send_picture(Session& session, std::vector<std::string> names, ChoosePicture choose) {
  session.beside([names = std::move(names),
                  choose = std::move(choose)](JobStore& store) { return picture_of(store, names, choose); },
                 [&session](std::optional<Sent> sent) {
                   if (!sent) return session.refuse(404, "no picture of such a job is here");
                   Answer answer{.type = sent->type, .may_be_kept = true};
                   answer.fields = {{"ETag", "\"" + sent->mark + "\""}};
                   const std::string_view kept = session.head().field("If-None-Match");
                   if (kept.find(sent->mark) != std::string_view::npos)
                     answer.status = 304;
                   else
                     answer.body = std::move(sent->bytes);
                   session.answer(answer);
                 });
}

double estimate_s(const StoredJob& job) {
  return job.preflight ? job.preflight->motion_s + job.preflight->dwell_s : job.notes.time_s();
}

}  // namespace kinebus::http
