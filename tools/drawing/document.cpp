#include "tools/drawing/document.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>

namespace kinebus::drawing {
namespace {

/// Rounded, without trailing zeros. What is no number is 0: a picture of bad data is still a picture.
void put(std::string& out, double value, int decimals = 1) {
  constexpr std::array<int, 4> kPowers{1, 10, 100, 1000};
  constexpr double kLargest = 1e7;
  const int power = kPowers[static_cast<std::size_t>(decimals)];
  const double safe = std::isnan(value) ? 0 : std::clamp(value, -kLargest, kLargest);
  const auto scaled = static_cast<std::int64_t>(std::llround(safe * power));
  if (scaled < 0) out += '-';
  const std::int64_t size = scaled < 0 ? -scaled : scaled;
  char digits[24];
  const auto write = [&](std::int64_t n) {
    const auto end = std::to_chars(digits, digits + sizeof digits, n).ptr;
    return std::string_view(digits, static_cast<std::size_t>(end - digits));
  };
  out += write(size / power);
  std::int64_t rest = size % power;
  if (rest == 0) return;
  out += '.';
  for (int p = power / 10; rest > 0; rest %= p, p /= 10) out += static_cast<char>('0' + rest / p);
}

void attribute(std::string& out, std::string_view name, double value, int decimals = 1) {
  out += ' ';
  out += name;
  out += "='";
  put(out, value, decimals);
  out += '\'';
}

void escape(std::string& out, std::string_view words) {
  for (const char c : words) {
    switch (c) {
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '&':
        out += "&amp;";
        break;
      case '\'':
        out += "&#39;";
        break;
      case '"':
        out += "&quot;";
        break;
      // XML allows no other control characters.
      default:
        out += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
    }
  }
}

void attribute(std::string& out, std::string_view name, std::string_view value) {
  if (value.empty()) return;
  out += ' ';
  out += name;
  out += "='";
  escape(out, value);
  out += '\'';
}

void put_style(std::string& out, const Style& s) {
  attribute(out, "fill", s.fill);
  attribute(out, "stroke", s.stroke);
  if (s.width > 0) attribute(out, "stroke-width", s.width, 2);
  if (s.fill_opacity < 1) attribute(out, "fill-opacity", s.fill_opacity, 2);
  if (s.stroke_opacity < 1) attribute(out, "stroke-opacity", s.stroke_opacity, 2);
  attribute(out, "stroke-dasharray", s.dash);
  if (s.round) out += " stroke-linecap='round' stroke-linejoin='round'";
  if (s.crisp) out += " shape-rendering='crispEdges'";
}

void put_rectangle(std::string& out, const Box& b, double corner) {
  out += "<rect";
  attribute(out, "x", b.x);
  attribute(out, "y", b.y);
  attribute(out, "width", b.width);
  attribute(out, "height", b.height);
  if (corner > 0) attribute(out, "rx", corner);
}

}  // namespace

Document::Document(double width, double height) : width_(width), height_(height) {}

void Document::heading(double x, std::string_view title, std::string_view subtitle) {
  text({x, 44}, title, {.size = 24, .bold = true});
  // SVG draws many spaces as one: items stand apart by a dot.
  std::string items;
  for (std::size_t at = 0; at < subtitle.size();) {
    const std::size_t gap = std::min(subtitle.find("  ", at), subtitle.size());
    items += subtitle.substr(at, gap - at);
    at = std::min(subtitle.find_first_not_of(' ', gap), subtitle.size());
    if (gap < at && at < subtitle.size() && gap > 0) items += " \u00b7 ";
  }
  text({x, 70}, items, {.size = 14, .fill = kMuted});
}

void Document::text(Point at, std::string_view words, const TextStyle& style) {
  if (words.empty()) return;
  body_ += "<text";
  attribute(body_, "x", at.x);
  attribute(body_, "y", at.y);
  attribute(body_, "font-size", style.size);
  if (style.anchor != Anchor::kStart)
    attribute(body_, "text-anchor", style.anchor == Anchor::kMiddle ? "middle" : "end");
  attribute(body_, "fill", style.fill);
  if (style.bold) attribute(body_, "font-weight", "bold");
  if (!style.halo.empty()) {
    attribute(body_, "stroke", style.halo);
    body_ += " stroke-width='3' paint-order='stroke'";
  }
  if (style.upwards) {
    body_ += " transform='rotate(-90 ";
    put(body_, at.x);
    body_ += ' ';
    put(body_, at.y);
    body_ += ")'";
  }
  body_ += '>';
  escape(body_, words);
  body_ += "</text>\n";
}

void Document::line(Point from, Point to, const Style& style) {
  body_ += "<line";
  attribute(body_, "x1", from.x);
  attribute(body_, "y1", from.y);
  attribute(body_, "x2", to.x);
  attribute(body_, "y2", to.y);
  put_style(body_, style);
  body_ += "/>\n";
}

void Document::path(std::span<const Point> points, bool closed, const Style& style) {
  if (points.empty()) return;
  body_ += "<path d='";
  char step = 'M';
  for (const Point& p : points) {
    body_ += step;
    put(body_, p.x);
    body_ += ' ';
    put(body_, p.y);
    step = 'L';
  }
  if (closed) body_ += 'Z';
  body_ += '\'';
  put_style(body_, style);
  body_ += "/>\n";
}

void Document::polyline(std::span<const Point> points, const Style& style) {
  Style open = style;
  open.fill = "none";
  path(points, false, open);
}

void Document::polygon(std::span<const Point> points, const Style& style) {
  path(points, true, style);
}

void Document::rectangle(const Box& box, const Style& style, double corner) {
  put_rectangle(body_, box, corner);
  put_style(body_, style);
  body_ += "/>\n";
}

void Document::circle(Point centre, double radius, const Style& style) {
  body_ += "<circle";
  attribute(body_, "cx", centre.x);
  attribute(body_, "cy", centre.y);
  attribute(body_, "r", radius, 2);
  put_style(body_, style);
  body_ += "/>\n";
}

void Document::ellipse(Point centre, double radius_x, double radius_y, const Style& style) {
  body_ += "<ellipse";
  attribute(body_, "cx", centre.x);
  attribute(body_, "cy", centre.y);
  attribute(body_, "rx", radius_x, 2);
  attribute(body_, "ry", radius_y, 2);
  put_style(body_, style);
  body_ += "/>\n";
}

Document::Group Document::group(const Style& style) {
  body_ += "<g";
  put_style(body_, style);
  body_ += ">\n";
  return Group(*this);
}

Document::Group Document::clipped(const Box& box, double corner) {
  const std::string name = "clip" + std::to_string(++names_);
  definitions_ += "<clipPath id='" + name + "'>";
  put_rectangle(definitions_, box, corner);
  definitions_ += "/></clipPath>\n";
  body_ += "<g clip-path='url(#" + name + ")'>\n";
  return Group(*this);
}

std::string Document::gradient(std::span<const GradientStop> stops) {
  const std::string name = "gradient" + std::to_string(++names_);
  definitions_ += "<linearGradient id='" + name + "'>";
  for (const GradientStop& stop : stops) {
    definitions_ += "<stop";
    attribute(definitions_, "offset", stop.offset, 2);
    attribute(definitions_, "stop-color", stop.colour);
    definitions_ += "/>";
  }
  definitions_ += "</linearGradient>\n";
  return "url(#" + name + ")";
}

std::string Document::svg() const {
  std::string out = "<svg xmlns='http://www.w3.org/2000/svg'";
  attribute(out, "width", width_);
  attribute(out, "height", height_);
  out += " viewBox='0 0 ";
  put(out, width_);
  out += ' ';
  put(out, height_);
  out += "' font-family='DejaVu Sans, Helvetica, Arial, sans-serif'";
  attribute(out, "fill", kInk);
  out += ">\n";
  if (!definitions_.empty()) out += "<defs>\n" + definitions_ + "</defs>\n";
  out += "<rect width='100%' height='100%' fill='white'/>\n";
  return out + body_ + "</svg>\n";
}

std::string rgb(double red, double green, double blue) {
  constexpr char kDigits[] = "0123456789abcdef";
  std::string out = "#";
  for (const double part : {red, green, blue}) {
    const auto value = static_cast<std::size_t>(std::lround(std::clamp(part, 0.0, 255.0)));
    out += kDigits[value / 16];
    out += kDigits[value % 16];
  }
  return out;
}

}  // namespace kinebus::drawing
