#pragma once
// The files of the web page, read at the daemon's start: what is served never waits for a disk. And the file
// of what web pages keep with the printer.

#include <filesystem>
#include <functional>
#include <string>

#include "gateway/result.hpp"
#include "gateway/sessions/http/http_server.hpp"

namespace kinebus {

/// All files under `folder`. Error: more than a page can be (32 MiB), or what cannot be read, in words.
Result<http::Pages, std::string> read_pages(const std::filesystem::path& folder);

/// Where the page is when nobody says so: share/kinebus/web beside this program's folder. Empty: there is
/// none.
std::filesystem::path installed_pages();

/// Empty where there is none.
std::string read_text(const std::filesystem::path& file);
/// Replaces `file` as a whole. What goes wrong is logged once.
std::function<void(const std::string& text)> text_keeper(std::filesystem::path file);

}  // namespace kinebus
