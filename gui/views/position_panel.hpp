#pragma once
// Where everything is: the tool's axes in large digits, the carriages as bars within their travel, the
// heaters.

#include <QColor>
#include <QGridLayout>
#include <QLabel>
#include <QPaintEvent>
#include <QVector>
#include <QWidget>

#include "gui/views/desk.hpp"
#include "gui/views/widgets.hpp"

namespace kinebus::gui {

/// A carriage within its travel.
class TravelBar : public QWidget {
  Q_OBJECT
 public:
  explicit TravelBar(QWidget* parent = nullptr);
  void set(double share, const QColor& colour);  ///< share < 0: not known

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  double share_ = -1;
  QColor colour_;
};

class PositionPanel : public SpeakingWidget {
  Q_OBJECT
 public:
  explicit PositionPanel(Desk& desk, QWidget* parent = nullptr);

 private:
  struct AxisRow {
    QLabel *name, *value, *unit;
  };
  struct JointRow {
    QLabel *name, *value;
    TravelBar* bar;
    QLabel* by_scale;  ///< below them; nullptr: the joint has no scale
    int joint;
  };
  QWidget* make_axes();
  void rebuild_joints();
  void take_status();

  Desk& desk_;
  QVector<AxisRow> axes_;
  Card* joints_card_;
  QGridLayout* joints_grid_;
  QLabel *frame_text_, *joints_heading_;
  QVector<JointRow> joints_;
};

}  // namespace kinebus::gui
