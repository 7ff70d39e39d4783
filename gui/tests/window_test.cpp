// The whole window under a real X server (xvfb-run) with software OpenGL, against a gateway made of paper.
#include <gtest/gtest.h>

#include <QAbstractItemModel>
#include <QApplication>
#include <QCoreApplication>
#include <QEvent>
#include <QImage>
#include <QKeyEvent>
#include <QLabel>
#include <QLatin1String>
#include <QPushButton>
#include <QRgb>
#include <QSettings>
#include <QSize>
#include <QStringList>
#include <QTableView>
#include <QTemporaryDir>
#include <set>

#include "gui/models/axes_model.hpp"
#include "gui/models/format.hpp"
#include "gui/tests/window_fixture.hpp"
#include "gui/views/machine_page.hpp"
#include "gui/views/main_window.hpp"
#include "gui/views/top_bar.hpp"
#include "gui/views/view_page.hpp"

namespace kinebus::gui {
namespace {

int colours_in(const QImage& image) {
  std::set<QRgb> colours;
  for (int y = 0; y < image.height(); y += 3)
    for (int x = 0; x < image.width(); x += 3) colours.insert(image.pixel(x, y));
  return static_cast<int>(colours.size());
}

/// Four carriages at 290 mm, each 12 um farther by its linear scale.
void give_scales(FakeGateway& gateway) {
  gateway.status.set_positions_known(true);
  gateway.status.clear_joints();
  for (int i = 0; i < 6; ++i) gateway.status.add_joints(i < 4 ? 290 : 0);
  for (int i = 0; i < 4; ++i) {
    gateway.machine.mutable_joints(i)->set_has_scale(true);
    gateway.status.mutable_nodes(i / 2)->mutable_axes(i % 2)->set_by_scale_mm(290.012);
  }
}

TEST_F(WindowTest, EveryPageIsDrawnInEveryLanguageAndTheme) {
  show_connected();
  for (const auto& language : Language::choices())
    for (const bool dark : {false, true}) {
      window->set_language(language.code);
      window->set_theme(dark);
      for (int page = 0; page < MainWindow::kPages; ++page) {
        window->show_page(static_cast<MainWindow::Page>(page));
        QCoreApplication::processEvents();
        const QImage image = window->grab().toImage();
        EXPECT_GT(colours_in(image), 30) << "page " << page << " in " << language.code.toStdString();
        const int ground = image.pixelColor(120, image.height() - 4).lightness();
        EXPECT_TRUE(dark ? ground < 90 : ground > 150) << "page " << page << " dark " << dark;
      }
    }
}

TEST_F(WindowTest, NoCellOfTheMachinePageIsCutInAnyLanguage) {
  give_scales(gateway);
  show_connected();
  window->resize(1280, 720);
  window->show_page(MainWindow::kMachine);
  for (int i = 0; i < 2 * static_cast<int>(Language::choices().size()); ++i) {
    const auto& language = Language::choices()[i / 2];
    window->set_language(language.code);
    window->machine_page().show_tab(i % 2 == 0 ? 0 : 3);
    QCoreApplication::processEvents();
    for (const QTableView* table : window->findChildren<QTableView*>()) {
      if (!table->isVisible()) continue;
      const QAbstractItemModel& model = *table->model();
      for (int column = 0; column < model.columnCount(); ++column) {
        if (table->isColumnHidden(column)) continue;
        QStringList texts{model.headerData(column, Qt::Horizontal).toString()};
        for (int row = 0; row < model.rowCount(); ++row) texts << model.index(row, column).data().toString();
        for (const QString& text : texts)
          EXPECT_LE(table->fontMetrics().horizontalAdvance(text) + 4, table->columnWidth(column))
              << language.code.toStdString() << ": " << text.toStdString();
      }
    }
  }
}

TEST_F(WindowTest, JointsWithScalesAreShownByThemOnTheMachinePageAndBesideTheirPlaces) {
  give_scales(gateway);
  show_connected();
  window->resize(1280, 720);
  for (const auto& language : Language::choices()) {
    window->set_language(language.code);
    QCoreApplication::processEvents();
    int shown = 0;
    for (const QLabel* label : window->findChildren<QLabel*>())
      if (label->isVisible() && label->text().contains(Format::number(290.012, 3)) &&
          label->text().contains(Format::number(12, 0))) {
        ++shown;
        EXPECT_LE(label->fontMetrics().horizontalAdvance(label->text()), label->width())
            << label->text().toStdString();
      }
    EXPECT_EQ(shown, 4) << "a label for each carriage, in " << language.code.toStdString();
    EXPECT_LE(window->minimumSizeHint().height(), 720) << language.code.toStdString();
  }
  window->show_page(MainWindow::kMachine);
  window->machine_page().show_tab(0);
  const auto axes_columns = [&] {
    QCoreApplication::processEvents();
    for (const QTableView* table : window->findChildren<QTableView*>())
      if (table->isVisible() && table->model() == &desk.axes)
        return !table->isColumnHidden(AxesModel::kByScale) && !table->isColumnHidden(AxesModel::kScaleError);
    return false;
  };
  EXPECT_TRUE(wait_until(axes_columns));
}

TEST_F(WindowTest, TheMotorsPageSetsCurrentsAndJogsOneMotor) {
  gateway.status.set_state(joblink::STATE_READY);
  show_connected();
  window->set_language(QStringLiteral("en"));
  window->show_page(MainWindow::kMachine);
  window->machine_page().show_tab(3);
  QCoreApplication::processEvents();
  int clicked = 0;
  for (QPushButton* button : window->findChildren<QPushButton*>())
    if (button->isVisible() && (button->text() == QStringLiteral("Set currents") ||
                                button->accessibleName() == QStringLiteral("Jog on") ||
                                button->text() == QStringLiteral("Measure the motor"))) {
      ASSERT_TRUE(button->isEnabled()) << button->text().toStdString();
      button->click();
      ++clicked;
    }
  EXPECT_EQ(clicked, 3);
  using C = joblink::ClientMessage;
  EXPECT_TRUE(wait_until([&] {
    return gateway.count(C::kSetMotorCurrents) == 1 && gateway.count(C::kJogMotor) == 1 &&
           gateway.count(C::kTuneMotor) == 1;
  }));
}

TEST_F(WindowTest, ArrowsJogAlsoAfterAButtonWasClicked) {
  gateway.status.set_state(joblink::STATE_READY);
  show_connected();
  window->set_language(QStringLiteral("en"));
  window->show_page(MainWindow::kJog);
  QPushButton* home = nullptr;
  for (QPushButton* button : window->findChildren<QPushButton*>())
    if (button->isVisible() && button->text() == QStringLiteral("Home")) home = button;
  ASSERT_NE(home, nullptr);
  home->setFocus();
  QKeyEvent press(QEvent::KeyPress, Qt::Key_Right, Qt::NoModifier);
  QKeyEvent release(QEvent::KeyRelease, Qt::Key_Right, Qt::NoModifier);
  QApplication::sendEvent(home, &press);
  QApplication::sendEvent(home, &release);
  EXPECT_TRUE(wait_until([&] { return gateway.count(joblink::ClientMessage::kJog) == 1; }));
}

TEST_F(WindowTest, PersianRunsFromRightToLeftAndBack) {
  show_connected();
  window->set_language(QStringLiteral("fa"));
  EXPECT_EQ(window->layoutDirection(), Qt::RightToLeft);
  EXPECT_TRUE(
      wait_until([&] { return window->top_bar().stop_button().text().trimmed() == QStringLiteral("ایست"); }));
  window->set_language(QStringLiteral("tr"));
  EXPECT_EQ(window->layoutDirection(), Qt::LeftToRight);
  EXPECT_TRUE(
      wait_until([&] { return window->top_bar().stop_button().text().trimmed() == QStringLiteral("DUR"); }));
}

TEST_F(WindowTest, StopIsOnEveryPageAndReachesTheGateway) {
  show_connected();
  for (int page = 0; page < MainWindow::kPages; ++page) {
    window->show_page(static_cast<MainWindow::Page>(page));
    EXPECT_TRUE(window->top_bar().stop_button().isVisible() && window->top_bar().stop_button().isEnabled());
  }
  window->top_bar().stop_button().click();
  EXPECT_TRUE(wait_until([&] { return gateway.count(joblink::ClientMessage::kStop) == 1; }));
}

TEST_F(WindowTest, StateIsSaidInPlainWords) {
  show_connected();
  for (const auto& [state, words] : {std::pair{joblink::STATE_UNHOMED, "Not homed"},
                                     {joblink::STATE_RUNNING, "Printing"},
                                     {joblink::STATE_ALARM, "Alarm"}}) {
    gateway.status.set_state(state);
    EXPECT_TRUE(wait_until([&] { return window->top_bar().chip().words() == QLatin1String(words); }))
        << words;
  }
}

TEST_F(WindowTest, FitsIntoASmallScreen) {
  show_connected();
  for (const auto& language : Language::choices()) {
    window->set_language(language.code);
    EXPECT_LE(window->minimumSizeHint().width(), 1280) << language.code.toStdString();
    EXPECT_LE(window->minimumSizeHint().height(), 720) << language.code.toStdString();
  }
}

TEST_F(WindowTest, LayoutIsRemembered) {
  show_connected();
  QTemporaryDir folder;
  QSettings settings(folder.filePath(QStringLiteral("layout.ini")), QSettings::IniFormat);
  window->view_page().set_colouring(PathColouring::kMargin);
  window->resize(1180, 690);
  window->save(settings);
  window = std::make_unique<MainWindow>(desk);
  window->restore(settings);
  EXPECT_EQ(window->size(), QSize(1180, 690));
  EXPECT_EQ(window->view_page().scene().content().colouring, PathColouring::kMargin);
}

TEST_F(WindowTest, AButtonThatCanDoNothingTellsWhyInTheGatewaysWords) {
  show_connected();
  const auto button = [&](const QString& text) -> QPushButton* {
    for (auto* found : window->findChildren<QPushButton*>())
      if (found->text() == text) return found;
    return nullptr;
  };
  QPushButton* reference = button(QStringLiteral("Bed reference"));
  ASSERT_NE(reference, nullptr);
  ASSERT_TRUE(wait_until([&] { return reference->isEnabled(); }));
  const QString does = reference->toolTip();
  gateway.allow({joblink::COMMAND_HOME});
  ASSERT_TRUE(wait_until([&] { return !reference->isEnabled(); }));
  EXPECT_EQ(reference->toolTip(), QStringLiteral("home it first"));
  gateway.allow({joblink::COMMAND_REFERENCE});
  ASSERT_TRUE(wait_until([&] { return reference->isEnabled(); }));
  EXPECT_EQ(reference->toolTip(), does);
}

TEST_F(WindowTest, LeavingTheGatewayEmptiesEveryPage) {
  show_connected();
  ASSERT_TRUE(wait_until([&] { return desk.session.machine().joints_size() > 0; }));
  desk.session.disconnect_from_gateway();
  EXPECT_EQ(window->page(), MainWindow::kConnect);
  for (int page = 0; page < MainWindow::kPages; ++page) {
    window->show_page(static_cast<MainWindow::Page>(page));
    EXPECT_FALSE(window->grab().isNull());
  }
}

}  // namespace
}  // namespace kinebus::gui
