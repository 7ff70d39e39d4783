#pragma once
// What Moonraker's clients keep with the printer: settings of web pages, as JSON in namespaces. In memory;
// its owner keeps the text.

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "gateway/result.hpp"

namespace kinebus::http {

class MoonrakerDatabase {
 public:
  using Json = nlohmann::ordered_json;
  static constexpr std::size_t kMaxBytes = 512U << 10;  ///< of text

  /// Text that cannot be read counts as none.
  explicit MoonrakerDatabase(const std::string& text = {});

  std::vector<std::string> namespaces() const;
  /// `key`: "a.b.c"; "": the whole namespace. Error: there is none.
  Result<Json, std::string> get(const std::string& space, const std::string& key) const;
  /// Error: no room, or something else stands in the way.
  Result<void, std::string> set(const std::string& space, const std::string& key, Json value);
  Result<Json, std::string> remove(const std::string& space, const std::string& key);
  std::string text() const;

 private:
  Json all_ = Json::object();
};

}  // namespace kinebus::http
