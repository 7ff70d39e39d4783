#include "gateway/sessions/http/moonraker/moonraker_database.hpp"

#include <utility>

namespace kinebus::http {
namespace {

constexpr std::size_t kMaxDepth = 32;

/// "a.b.c": a, b, c.
std::vector<std::string> pieces_of(const std::string& space, const std::string& key) {
  std::vector<std::string> pieces{space};
  for (std::size_t at = 0; !key.empty() && at <= key.size();) {
    const std::size_t end = std::min(key.find('.', at), key.size());
    pieces.push_back(key.substr(at, end - at));
    at = end + 1;
  }
  return pieces;
}

}  // namespace

MoonrakerDatabase::MoonrakerDatabase(const std::string& text) {
  Json read = Json::parse(text, nullptr, false);
  if (read.is_object()) all_ = std::move(read);
}

std::vector<std::string> MoonrakerDatabase::namespaces() const {
  std::vector<std::string> names;
  for (const auto& [name, value] : all_.items()) names.push_back(name);
  return names;
}

Result<MoonrakerDatabase::Json, std::string> MoonrakerDatabase::get(const std::string& space,
                                                                    const std::string& key) const {
  const Json* at = &all_;
  for (const std::string& piece : pieces_of(space, key)) {
    if (!at->is_object() || !at->contains(piece))
      return Error<std::string>(std::string("nothing is kept under '")
                                    .append(piece)
                                    .append("' of namespace '")
                                    .append(space)
                                    .append("'"));
    at = &(*at)[piece];
  }
  return *at;
}

Result<void, std::string> MoonrakerDatabase::set(const std::string& space, const std::string& key,
                                                 Json value) {
  const auto pieces = pieces_of(space, key);
  if (space.empty() || pieces.size() > kMaxDepth) return Error<std::string>("a key has 1 to 32 pieces");
  Json changed = all_;
  Json* at = &changed;
  for (const std::string& piece : pieces) {
    if (at->is_null()) *at = Json::object();
    if (!at->is_object()) return Error<std::string>("'" + piece + "' would stand in what is no object");
    at = &(*at)[piece];
  }
  *at = std::move(value);
  std::swap(changed, all_);
  if (text().size() <= kMaxBytes) return {};
  std::swap(changed, all_);
  return Error<std::string>("there is no room: all namespaces together have at most 512 KiB");
}

Result<MoonrakerDatabase::Json, std::string> MoonrakerDatabase::remove(const std::string& space,
                                                                       const std::string& key) {
  auto pieces = pieces_of(space, key);
  auto value = get(space, key);
  if (!value) return value;
  Json* at = &all_;
  for (std::size_t i = 0; i + 1 < pieces.size(); ++i) at = &(*at)[pieces[i]];
  at->erase(pieces.back());
  return value;
}

std::string MoonrakerDatabase::text() const {
  return all_.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace kinebus::http
