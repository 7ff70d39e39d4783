// Window tests: Google Test under a Qt application with the scene's OpenGL.
#include <gtest/gtest.h>

#include <QApplication>
#include <QCoreApplication>
#include <QString>

#include "gui/views/scene_view.hpp"

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  kinebus::gui::SceneView::choose_format();
  QCoreApplication::setApplicationName(QStringLiteral("kinebus-gui-test"));
  QApplication app(argc, argv);
  return RUN_ALL_TESTS();
}
