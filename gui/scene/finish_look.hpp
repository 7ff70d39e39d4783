#pragma once
// How each finish of a machine's parts is drawn.

#include <QVector3D>

#include "gui/scene/machine_figure.hpp"

namespace kinebus::gui {

struct Look {
  QVector3D light, dark;
  float gloss = 0.1F;
  float glow = 0;
};

Look look_of(Finish finish);

}  // namespace kinebus::gui
