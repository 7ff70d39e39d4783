#pragma once
// A picture as SVG: shapes and words in pixels, y downwards. Words are escaped, numbers are short and never
// "-0".
//
// Our own: Debian's C++ plot libraries draw pixels or bring Qt, Cairo or gnuplot along; SVG as these tools
// need it is text.

#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace kinebus::drawing {

inline constexpr std::string_view kInk = "#1d2733", kMuted = "#5a6672", kFaint = "#c9d1d9", kGrid = "#e4e8ec";

struct Point {
  double x = 0, y = 0;
};

struct Box {
  double x = 0, y = 0, width = 0, height = 0;
  double right() const { return x + width; }
  double bottom() const { return y + height; }
};

/// Colours as SVG has them: "#1d2733", "white", "none". What is empty or 0 is as the group around says.
struct Style {
  std::string_view fill{}, stroke{};
  double width = 0;  ///< of the stroke
  double fill_opacity = 1, stroke_opacity = 1;
  std::string_view dash{};
  bool round = false;  ///< caps and joins
  bool crisp = false;  ///< no smoothing: neighbouring rectangles leave no seam
};

enum class Anchor { kStart, kMiddle, kEnd };

struct TextStyle {
  double size = 13;
  Anchor anchor = Anchor::kStart;
  std::string_view fill{};
  bool bold = false;
  std::string_view halo{};  ///< colour of a rim that keeps words readable on a picture
  bool upwards = false;     ///< turned to be read from below to above
};

struct GradientStop {
  double offset = 0;
  std::string_view colour;
};

class Document {
 public:
  Document(double width, double height);  ///< white

  /// The picture's name and one line below it, at the top; items of that line have two spaces or more between
  /// them, and are drawn apart.
  void heading(double x, std::string_view title, std::string_view subtitle);
  void text(Point at, std::string_view words, const TextStyle& style);
  void line(Point from, Point to, const Style& style);
  void polyline(std::span<const Point> points, const Style& style);  ///< open, not filled
  void polygon(std::span<const Point> points, const Style& style);
  void rectangle(const Box& box, const Style& style, double corner = 0);
  void circle(Point centre, double radius, const Style& style);
  void ellipse(Point centre, double radius_x, double radius_y, const Style& style);

  /// What is drawn until its end shares a style, and is cut off at the box if there is one.
  class Group {
   public:
    Group(const Group&) = delete;
    Group& operator=(const Group&) = delete;
    ~Group() { document_.body_ += "</g>\n"; }

   private:
    friend class Document;
    explicit Group(Document& document) : document_(document) {}
    Document& document_;
  };
  [[nodiscard]] Group group(const Style& style);
  [[nodiscard]] Group clipped(const Box& box, double corner);

  /// From left to right; the result is a fill.
  std::string gradient(std::span<const GradientStop> stops);

  std::string svg() const;

 private:
  void path(std::span<const Point> points, bool closed, const Style& style);

  double width_, height_;
  int names_ = 0;  // given to gradients and clips
  std::string definitions_, body_;
};

/// "#1d2733" of 0..255 each; what is beyond is cut off.
std::string rgb(double red, double green, double blue);

}  // namespace kinebus::drawing
