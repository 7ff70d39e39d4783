// Moonraker's API: files.

#include <algorithm>
#include <array>
#include <charconv>
#include <utility>

#include "gateway/sessions/http/moonraker/moonraker.hpp"
#include "gateway/sessions/http/pictures.hpp"

namespace kinebus::http {
namespace {

constexpr const char* kRoot = "gcodes";

/// "gcodes/a.gcode": "a.gcode". What is in no other folder.
std::string name_of(const std::string& path) {
  const std::string_view root = "gcodes/";
  return path.starts_with(root) ? path.substr(root.size()) : path;
}

/// ".thumbs/a.gcode-220x124.png"
std::string picture_path(const StoredJob& job, const joblink::SlicerPicture& picture) {
  return ".thumbs/" + job.name + "-" + std::to_string(picture.width_px()) + "x" +
         std::to_string(picture.height_px()) + (picture.jpeg() ? ".jpg" : ".png");
}

/// `path_name`: how the field with the path is called.
Json pictures_json(const StoredJob& job, const char* path_name) {
  Json pictures = Json::array();
  for (const auto& picture : job.notes.pictures())
    pictures.push_back({{"width", picture.width_px()},
                        {"height", picture.height_px()},
                        {"size", picture.size_bytes()},
                        {path_name, picture_path(job, picture)}});
  return pictures;
}

/// What the slicer said, as far as it did.
void add_slicer_notes(Json& file, const StoredJob& job) {
  const joblink::SlicerNotes& notes = job.notes;
  const auto add = [&](const char* name, const auto& value) {
    if (value != std::decay_t<decltype(value)>{}) file[name] = value;
  };
  add("slicer", notes.slicer());
  add("slicer_version", notes.slicer_version());
  add("estimated_time", estimate_s(job));
  add("filament_total", notes.filament_mm());
  add("filament_weight_total", notes.filament_g());
  add("filament_type", notes.filament_type());
  add("layer_height", notes.layer_mm());
  add("first_layer_height", notes.first_layer_mm());
  add("object_height", notes.object_height_mm());
  add("nozzle_diameter", notes.nozzle_mm());
  add("first_layer_extr_temp", notes.first_layer_hotend_celsius());
  add("first_layer_bed_temp", notes.first_layer_bed_celsius());
  if (notes.pictures_size() > 0) file["thumbnails"] = pictures_json(job, "relative_path");
}

Json file_json(const StoredJob& job, const char* name) {
  Json file = {
      {name, job.name}, {"modified", job.stored_unix_s}, {"size", job.size_bytes}, {"permissions", "rw"}};
  add_slicer_notes(file, job);
  if (job.last_run) {
    file["print_start_time"] = job.last_run->begun_unix_s;
    file["job_id"] = std::to_string(job.last_run->id);
  }
  return file;
}

/// All stored jobs, made into the result by `make`.
void with_jobs(const Call& call, Json (*make)(const JobListing&)) {
  call.caller.beside(
      [make](JobStore& store) {
        const auto listing = all_jobs(store);
        if (!listing)
          return Result<Json, RpcError>(Error<RpcError>(RpcError{500, listing.error().words.english()}));
        return Result<Json, RpcError>(make(*listing));
      },
      [call](Result<Json, RpcError> made) { call.then(std::move(made)); });
}

void list_files(const Call& call) {
  const std::string root = call.text("root");
  if (!root.empty() && root != kRoot) return call.done(Json::array());
  with_jobs(call, [](const JobListing& listing) {
    Json files = Json::array();
    for (const StoredJob& job : listing.jobs) files.push_back(file_json(job, "path"));
    return files;
  });
}

void directory(const Call& call) {
  const std::string path = call.text("path");
  if (!path.empty() && path != kRoot) return call.fail(404, "there is one folder: gcodes");
  with_jobs(call, [](const JobListing& listing) {
    Json files = Json::array();
    for (const StoredJob& job : listing.jobs) files.push_back(file_json(job, "filename"));
    const std::uint64_t quota = listing.quota_bytes;
    return Json{{"dirs", Json::array()},
                {"files", std::move(files)},
                {"disk_usage",
                 {{"total", quota},
                  {"used", listing.used_bytes},
                  {"free", std::min(listing.free_bytes, quota - std::min(quota, listing.used_bytes))}}},
                {"root_info", {{"name", kRoot}, {"permissions", "rw"}}}};
  });
}

void roots(const Call& call) {
  call.done(Json::array({{{"name", kRoot}, {"path", kRoot}, {"permissions", "rw"}}}));
}

void metadata(const Call& call) {
  call.caller.beside([name = name_of(call.text("filename"))](JobStore& store) { return store.find(name); },
                     [call](const std::optional<StoredJob>& job) {
                       if (!job) return call.fail(404, "no stored job has this name");
                       call.done(file_json(*job, "filename"));
                     });
}

void thumbnails(const Call& call) {
  call.caller.beside([name = name_of(call.text("filename"))](JobStore& store) { return store.find(name); },
                     [call](const std::optional<StoredJob>& job) {
                       if (!job) return call.fail(404, "no stored job has this name");
                       call.done(pictures_json(*job, "thumbnail_path"));
                     });
}

void delete_file(const Call& call) {
  const std::string name = name_of(call.text("path"));
  joblink::ClientMessage message;
  message.mutable_delete_job()->set_name(name);
  call.caller.command(message, [call, name](const joblink::Reply& reply) {
    if (reply.has_error()) return call.fail(400, words_of(reply.error()));
    call.done({{"item", {{"path", name}, {"root", kRoot}}}, {"action", "delete_file"}});
  });
}

/// "220x124"
std::pair<std::uint32_t, std::uint32_t> size_of(std::string_view text) {
  std::pair<std::uint32_t, std::uint32_t> size;
  const char* end = text.data() + text.size();
  const auto width = std::from_chars(text.data(), end, size.first);
  if (width.ptr == end || *width.ptr != 'x') return {};
  const auto height = std::from_chars(width.ptr + 1, end, size.second);
  return height.ptr == end ? size : std::pair<std::uint32_t, std::uint32_t>{};
}

}  // namespace

void send_gcode_picture(Session& session, std::string_view) {
  const std::string& file = session.target().path.back();
  const std::string_view front = std::string_view(file).substr(0, file.rfind('.'));
  const std::size_t dash = std::min(front.rfind('-'), front.size());
  const auto size = size_of(front.substr(std::min(dash + 1, front.size())));
  send_picture(session, {std::string(front.substr(0, dash))}, [size](const joblink::SlicerNotes& notes) {
    for (const auto& picture : notes.pictures())
      if (picture.width_px() == size.first && picture.height_px() == size.second) return &picture;
    return static_cast<const joblink::SlicerPicture*>(nullptr);
  });
}

std::span<const Method> moonraker_file_methods() {
  static constexpr std::array kMethods{
      Method{"server.files.list", "GET", "server/files/list", list_files},
      Method{"server.files.get_directory", "GET", "server/files/directory", directory},
      Method{"server.files.roots", "GET", "server/files/roots", roots},
      Method{"server.files.metadata", "GET", "server/files/metadata", metadata},
      // What is known of a job is read when it is stored.
      Method{"server.files.metascan", "POST", "server/files/metascan", metadata},
      Method{"server.files.thumbnails", "GET", "server/files/thumbnails", thumbnails},
      Method{"server.files.delete_file", nullptr, nullptr, delete_file},
  };
  return kMethods;
}

}  // namespace kinebus::http
