#pragma once
// What the colours of the path mean.

#include <QPaintEvent>
#include <QPainter>
#include <QSize>
#include <QString>
#include <QWidget>
#include <array>
#include <vector>

#include "gui/scene/path_colours.hpp"

namespace kinebus::gui {

/// A bar in the colours of the path with its two ends named, or a colour for each kind.
class RampLegend : public QWidget {
  Q_OBJECT
 public:
  explicit RampLegend(QWidget* parent = nullptr);
  void set(PathColouring colouring, const QString& low, const QString& high);
  struct Kind {
    std::array<float, 3> colour;
    QString name;
  };
  void set(std::vector<Kind> kinds);
  QSize sizeHint() const override;

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  void paint_kinds(QPainter& painter);

  PathColouring colouring_ = PathColouring::kFeed;
  QString low_, high_;
  std::vector<Kind> kinds_;  ///< none: a ramp
};

}  // namespace kinebus::gui
