#include "gateway/description/camera_address.hpp"

#include <algorithm>

namespace kinebus {
namespace {

constexpr std::size_t kLongest = 200, kPortDigits = 5;
constexpr std::string_view kSchemes[] = {"http://", "https://"};

constexpr bool is_digit(char c) {
  return c >= '0' && c <= '9';
}
constexpr bool is_letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}

bool consists_of(std::string_view text, std::string_view marks) {
  return std::all_of(text.begin(), text.end(), [&](char c) {
    return is_digit(c) || is_letter(c) || marks.find(c) != std::string_view::npos;
  });
}

/// ":8081", or nothing.
bool is_port(std::string_view text) {
  if (text.empty()) return true;
  const std::string_view digits = text.substr(1);
  return text[0] == ':' && !digits.empty() && digits.size() <= kPortDigits &&
         std::all_of(digits.begin(), digits.end(), is_digit) && std::stoi(std::string(digits)) <= 65535;
}

std::size_t end_of_name(std::string_view host) {
  const std::size_t bracket = host.rfind(']');
  return std::min(host.find(':', bracket == std::string_view::npos ? 0 : bracket), host.size());
}

bool is_host(std::string_view text) {
  const std::size_t end = end_of_name(text);
  const std::string_view name = text.substr(0, end);
  if (name.empty() || !is_port(text.substr(end))) return false;
  if (name.front() != '[') return consists_of(name, "-.");
  return name.back() == ']' && name.size() > 2 && consists_of(name.substr(1, name.size() - 2), ":.");
}

std::size_t length_of_scheme(std::string_view address) {
  for (const std::string_view scheme : kSchemes)
    if (address.starts_with(scheme)) return scheme.size();
  return 0;
}

}  // namespace

bool is_camera_address(std::string_view text) {
  if (text.size() > kLongest) return false;
  const std::size_t begin = length_of_scheme(text);
  const std::size_t path = text.find('/', begin);
  if (path == std::string_view::npos) return false;
  const std::string_view host = text.substr(begin, path - begin);
  const bool fits = begin > 0 ? is_host(host) : !host.empty() && is_port(host);
  return fits && consists_of(text.substr(path), "-._~/?=&%+@");
}

std::string camera_address_from(std::string_view address, std::string_view host) {
  if (!address.starts_with(':')) return std::string(address);
  return "http://" + std::string(host.substr(0, end_of_name(host))) + std::string(address);
}

std::string_view camera_origin(std::string_view address) {
  return address.substr(0, address.find('/', length_of_scheme(address)));
}

}  // namespace kinebus
