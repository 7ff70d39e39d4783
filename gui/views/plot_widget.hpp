#pragma once
// One curve of the last two minutes.

#include <QPaintEvent>
#include <QSize>
#include <QWidget>

#include "gui/models/status_history.hpp"
#include "gui/views/theme.hpp"

namespace kinebus::gui {

class PlotWidget : public QWidget {
  Q_OBJECT
 public:
  using Words = std::function<QString(double)>;
  /// full_scale: of the vertical axis at least; it grows with the values. `words` says a value to the user.
  PlotWidget(const StatusHistory& history, const Theme& theme, StatusHistory::Series series,
             double full_scale, Words words, QWidget* parent = nullptr);
  void set_title(const QString& title);
  QSize sizeHint() const override { return {260, 132}; }

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  const StatusHistory& history_;
  const Theme& theme_;
  StatusHistory::Series series_;
  double full_scale_;
  Words words_;
  QString title_;
};

}  // namespace kinebus::gui
