// Words on every page: those of the language at work, whole at 1024 x 640, and a name for all that a screen
// reader reads.
#include <gtest/gtest.h>

#include <QAbstractButton>
#include <QAbstractItemModel>
#include <QAccessible>
#include <QApplication>
#include <QComboBox>
#include <QGroupBox>
#include <QHeaderView>
#include <QImage>
#include <QLabel>
#include <QLineEdit>
#include <QListView>
#include <QMenu>
#include <QPlainTextEdit>
#include <QPushButton>
#include <QScrollArea>
#include <QScrollBar>
#include <QSlider>
#include <QSpinBox>
#include <QTabBar>
#include <QTabWidget>
#include <QTableView>
#include <QToolButton>
#include <functional>

#include "gui/tests/window_fixture.hpp"
#include "gui/views/heat_plot.hpp"
#include "gui/views/jobs_page.hpp"
#include "gui/views/machine_file_editor.hpp"
#include "gui/views/machine_page.hpp"
#include "gui/views/widgets.hpp"

namespace kinebus::gui {
namespace {

constexpr int kMachineTabs = 5;

class WordsTest : public WindowTest {
 protected:
  void SetUp() override {
    gateway.jobs["vase.gcode"] = "G1 X1 F600\n";
    gateway.machine.mutable_filament_ways()->set_unload_mm(70);
    gateway.machine.mutable_filament_ways()->set_load_mm(55);
    gateway.machine.mutable_filament_ways()->set_purge_mm(25);
    auto& material = *gateway.machine.add_materials();
    material.set_name("PLA");
    material.set_hotend_celsius(210);
    auto& problem = *gateway.preflight.add_problems();
    problem.set_error(false);
    problem.set_line(1);
    problem.set_words("slow");
    gateway.preflight.mutable_summary()->set_warnings(1);
    // As after some minutes of a print.
    gateway.status.mutable_counters()->set_frames_sent(123456);
    gateway.status.mutable_counters()->set_frames_received(23456);
    gateway.status.mutable_counters()->set_segments_sent(98765);
  }
  /// One event of each kind, a job that is checked, the machine file read.
  void fill() {
    show_connected();
    ASSERT_TRUE(wait_until([&] { return desk.jobs.rowCount() == 1; }));
    window->jobs_page().select(QStringLiteral("vase.gcode"));
    window->jobs_page().check();
    window->machine_page().editor().read_if_empty();
    ASSERT_TRUE(wait_until([&] {
      return !window->jobs_page().checking() && !window->machine_page().editor().text().document()->isEmpty();
    }));
    joblink::Event event;
    for (const auto kind :
         {joblink::EVENT_MESSAGE, joblink::EVENT_PROBLEM, joblink::EVENT_CONTROL, joblink::EVENT_ALARM}) {
      event.set_id(event.id() + 1);
      event.set_kind(kind);
      event.set_code(kind == joblink::EVENT_ALARM ? 0x8130 : 0);
      event.set_node(2);
      event.set_line(3);
      gateway.say(event);
    }
    ASSERT_TRUE(wait_until([&] { return desk.events.rowCount() == 4; }));
    settle();
  }
  void settle() {
    const double from = desk.session.status().time_s();
    ASSERT_TRUE(wait_until([&] { return desk.session.status().time_s() > from + 0.1; }));
  }
  /// On every page, and every tab of the machine's.
  void each_page(const std::function<void(const std::string&)>& look) {
    for (int page = 0; page < MainWindow::kPages; ++page) {
      window->show_page(static_cast<MainWindow::Page>(page));
      for (int tab = 0; tab < (page == MainWindow::kMachine ? kMachineTabs : 1); ++tab) {
        if (page == MainWindow::kMachine) window->machine_page().show_tab(tab);
        QCoreApplication::processEvents();
        // A status that came last has set words whose places are still to be laid out.
        QCoreApplication::sendPostedEvents();
        look("page " + std::to_string(page) + " tab " + std::to_string(tab));
      }
    }
  }
  void nothing_is_cut() {
    window->resize(1024, 640);
    for (const auto& language : Language::choices()) {
      window->set_language(language.code);
      settle();
      ASSERT_EQ(window->size(), QSize(1024, 640)) << language.code.toStdString();
      each_page([&](const std::string& page) {
        const std::string where = language.code.toStdString() + ", " + page + ": ";
        for (const auto* button : window->findChildren<QAbstractButton*>()) {
          if (!button->isVisible() || button->text().isEmpty()) continue;
          EXPECT_GE(button->width() + 1, button->minimumSizeHint().width())
              << where << button->text().toStdString();
          const int words = button->fontMetrics().size(Qt::TextShowMnemonic, button->text()).width();
          EXPECT_GE(button->width(), words + 4) << where << button->text().toStdString();
          EXPECT_GE(button->height() + 1, button->fontMetrics().height())
              << where << button->text().toStdString();
        }
        for (const auto* label : window->findChildren<QLabel*>()) {
          if (!label->isVisible() || label->text().isEmpty()) continue;
          if (qobject_cast<const ElidedLabel*>(label) != nullptr)
            continue;  // cut with dots, whole in its tip
          if (label->wordWrap()) {
            EXPECT_GE(label->height() + 1, label->heightForWidth(label->width()))
                << where << label->text().toStdString();
          } else {
            EXPECT_GE(label->width() + 1, label->sizeHint().width()) << where << label->text().toStdString();
          }
        }
        for (const auto* tabs : window->findChildren<QTabBar*>()) {
          if (!tabs->isVisible()) continue;
          for (int i = 0; i < tabs->count(); ++i)
            EXPECT_TRUE(tabs->rect().contains(tabs->tabRect(i))) << where << tabs->tabText(i).toStdString();
        }
        // Plots and cards stand beside each other, none on another.
        for (const auto* plot : window->findChildren<HeatPlot*>()) {
          if (!plot->isVisible()) continue;
          for (const auto* other : plot->parentWidget()->findChildren<QWidget*>(Qt::FindDirectChildrenOnly))
            EXPECT_FALSE(other != plot && other->isVisible() &&
                         other->geometry().intersects(plot->geometry()))
                << where << other->accessibleName().toStdString();
        }
        // Nothing lies beside the window, or under what scrolls down alone.
        for (const auto* widget : window->findChildren<QWidget*>()) {
          if (!widget->isVisible() || qobject_cast<const QAbstractButton*>(widget) == nullptr) continue;
          const QRect seen = widget->visibleRegion().boundingRect();
          const bool scrolled = seen.isEmpty() || seen.height() < widget->height();
          EXPECT_TRUE(scrolled || seen.width() == widget->width())
              << where << qobject_cast<const QAbstractButton*>(widget)->text().toStdString();
        }
      });
    }
  }
  std::map<std::string, QStringList> words() {
    std::map<std::string, QStringList> all;
    const auto add = [&](const QWidget& of, const char* what, const QString& text) {
      QString key = QString::fromLatin1(of.metaObject()->className());
      all[key.toStdString() + "." + what] << text;
    };
    for (const QWidget* widget : window->findChildren<QWidget*>()) {
      add(*widget, "tip", widget->toolTip());
      add(*widget, "name", widget->accessibleName());
      if (const auto* label = qobject_cast<const QLabel*>(widget)) add(*label, "text", label->text());
      if (const auto* button = qobject_cast<const QAbstractButton*>(widget))
        add(*button, "text", button->text());
      if (const auto* box = qobject_cast<const QComboBox*>(widget))
        for (int i = 0; i < box->count(); ++i) add(*box, "item", box->itemText(i));
      if (const auto* spin = qobject_cast<const QAbstractSpinBox*>(widget)) add(*spin, "text", spin->text());
      if (const auto* line = qobject_cast<const QLineEdit*>(widget))
        add(*line, "hint", line->placeholderText());
      if (const auto* text = qobject_cast<const QPlainTextEdit*>(widget))
        add(*text, "hint", text->placeholderText());
      if (const auto* tabs = qobject_cast<const QTabBar*>(widget))
        for (int i = 0; i < tabs->count(); ++i) add(*tabs, "tab", tabs->tabText(i));
      if (const auto* menu = qobject_cast<const QMenu*>(widget))
        for (const QAction* action : menu->actions()) add(*menu, "action", action->text());
      if (const auto* view = qobject_cast<const QAbstractItemView*>(widget);
          view != nullptr && view->model() != nullptr) {
        if (qobject_cast<const QHeaderView*>(view) != nullptr) continue;
        const QAbstractItemModel& model = *view->model();
        for (int column = 0; column < model.columnCount(); ++column) {
          add(*view, "header", model.headerData(column, Qt::Horizontal).toString());
          for (int row = 0; row < model.rowCount(); ++row)
            for (const int role : {static_cast<int>(Qt::DisplayRole), static_cast<int>(EventsModel::kDetails),
                                   static_cast<int>(EventsModel::kAdvice)})
              if (role == Qt::DisplayRole || model.columnCount() == 1)
                add(*view, "cell", model.index(row, column).data(role).toString());
        }
      }
    }
    for (auto& [key, list] : all) list.sort();
    return all;
  }
};

TEST_F(WordsTest, ALanguageThatIsSwitchedLiveLeavesNoForeignLine) {
  fill();
  if (HasFatalFailure()) return;
  for (const char* code : {"tr", "fa", "en"}) {
    const QString language = QString::fromLatin1(code);
    // From another language than the one in which the window was made, and again from the one before.
    window->set_language(QString::fromLatin1(code == std::string("tr") ? "fa" : "tr"));
    settle();
    window->set_language(language);
    settle();
    const auto switched = words();
    window = std::make_unique<MainWindow>(desk);
    window->show();
    window->jobs_page().select(QStringLiteral("vase.gcode"));
    window->jobs_page().check();
    window->machine_page().editor().read_if_empty();
    ASSERT_TRUE(wait_until([&] {
      return !window->jobs_page().checking() && !window->machine_page().editor().text().document()->isEmpty();
    }));
    settle();
    const auto made_so = words();
    EXPECT_EQ(switched.size(), made_so.size());
    for (const auto& [key, list] : made_so) {
      const auto other = switched.find(key);
      ASSERT_NE(other, switched.end()) << key;
      for (const QString& text : other->second)
        EXPECT_TRUE(list.contains(text)) << code << " after a switch, " << key << ": " << text.toStdString();
      for (const QString& text : list)
        EXPECT_TRUE(other->second.contains(text))
            << code << " made so, " << key << ": " << text.toStdString();
    }
  }
}

/// What a user can do something with, and every picture.
bool needs_a_name(const QAccessibleInterface& about) {
  switch (about.role()) {
    case QAccessible::Button:
    case QAccessible::CheckBox:
    case QAccessible::RadioButton:
    case QAccessible::ComboBox:
    case QAccessible::SpinBox:
    case QAccessible::Slider:
    case QAccessible::EditableText:
    case QAccessible::Table:
    case QAccessible::List:
    case QAccessible::Tree:
    case QAccessible::PageTab:
    case QAccessible::ButtonMenu:
    case QAccessible::ProgressBar:
    case QAccessible::MenuItem:
      return true;
    default:
      return about.state().focusable != 0 && about.role() != QAccessible::Cell &&
             about.role() != QAccessible::ListItem;
  }
}

TEST_F(WordsTest, EverythingAScreenReaderReadsHasAName) {
  fill();
  if (HasFatalFailure()) return;
  int named = 0;
  each_page([&](const std::string& page) {
    std::function<void(QAccessibleInterface*, const std::string&)> look = [&](QAccessibleInterface* about,
                                                                              const std::string& way) {
      if (about == nullptr || about->state().invisible != 0) return;
      const auto* object = about->object();
      const std::string here = way + "/" + (object != nullptr ? object->metaObject()->className() : "?");
      const QString name = about->text(QAccessible::Name);
      if (needs_a_name(*about)) {
        ++named;
        EXPECT_FALSE(name.trimmed().isEmpty())
            << page << ": " << here << " role " << static_cast<int>(about->role());
      }
      for (int i = 0; i < about->childCount(); ++i) {
        // Parts of a field or a list are read with it.
        const auto role = about->role();
        if (role == QAccessible::SpinBox || role == QAccessible::ComboBox || role == QAccessible::ScrollBar ||
            role == QAccessible::Table || role == QAccessible::List)
          break;
        look(about->child(i), here);
      }
    };
    look(QAccessible::queryAccessibleInterface(window.get()), "");
  });
  EXPECT_GT(named, 200);
}

TEST_F(WordsTest, NoButtonAndNoNameIsCutAt1024By640) {
  fill();
  if (HasFatalFailure()) return;
  nothing_is_cut();
}

/// The column farthest right of which something is drawn between two rows.
int rightmost_ink(const QImage& picture, int from, int to) {
  for (int x = picture.width() - 1; x >= 0; --x)
    for (int y = from; y < to; ++y)
      if (qGray(picture.pixel(x, y)) < 128) return x;
  return -1;
}

TEST(WrappedWords, BeginAtTheSameEdgeInEveryLineFromTheRight) {
  QLabel label;
  label.setLayoutDirection(Qt::RightToLeft);
  label.setStyleSheet(QStringLiteral("background: white; color: black"));
  label.setText(QStringLiteral("گام گام گام گام گام گام گام گام گام گام گام گام گام"));
  wrap_words(label);
  label.resize(120, label.heightForWidth(120));
  const int line = label.fontMetrics().lineSpacing();
  ASSERT_GT(label.height(), 2 * line);
  const QImage picture = label.grab().toImage().convertToFormat(QImage::Format_RGB32);
  const int first = rightmost_ink(picture, 0, line);
  // The space at the end of a line takes no room, and pushes no letter out.
  EXPECT_EQ(first, rightmost_ink(picture, label.height() - line, label.height()));
  EXPECT_GE(first, picture.width() - 4);
}

/// Where a line of text has its character, from the left edge.
qreal place_of(const QString& text, qsizetype at) {
  QTextOption option;
  option.setTextDirection(Qt::RightToLeft);
  QTextLayout layout(text);
  layout.setTextOption(option);
  layout.beginLayout();
  QTextLine line = layout.createLine();
  line.setLineWidth(10'000);
  layout.endLayout();
  return line.cursorToX(static_cast<int>(at));
}

TEST_F(WordsTest, APathIsReadFromTheLeftInPersianToo) {
  show_connected();
  window->set_language(QStringLiteral("fa"));
  desk.session.connect_to([path = gateway.socket_path()] { return std::make_unique<SocketLink>(path); },
                          QStringLiteral("/run/kinebus/gateway.sock"));
  settle();
  const QString shown = desk.session.gateway_title();
  const qsizetype slash = shown.indexOf(QLatin1Char('/'));
  ASSERT_GE(slash, 0) << shown.toStdString();
  EXPECT_GT(place_of(shown, slash + 1), 1) << "its first stroke is left of its first letter";
  EXPECT_LT(place_of(shown, slash + 1), place_of(shown, slash + 3));
}

TEST_F(WordsTest, APageTurnsWhenItsButtonIsToggledAsAScreenReaderDoes) {
  fill();
  if (HasFatalFailure()) return;
  for (const int page : {MainWindow::kJog, MainWindow::kJobs, MainWindow::kMachine, MainWindow::kView}) {
    const QString key = QStringLiteral("Ctrl+%1)").arg(page + 1);
    QAbstractButton* found = nullptr;
    for (auto* button : window->findChildren<QAbstractButton*>())
      if (button->toolTip().contains(key)) found = button;
    ASSERT_NE(found, nullptr) << key.toStdString();
    QAccessible::queryAccessibleInterface(found)->actionInterface()->doAction(
        QAccessibleActionInterface::toggleAction());
    EXPECT_EQ(window->page(), page);
  }
}

TEST_F(WordsTest, NothingIsCutWhenAJobTellsWhatItTook) {
  fill();
  if (HasFatalFailure()) return;
  gateway.status.mutable_nodes(0)->set_sync_error_s(17.25e-6);
  gateway.status.set_bus_load(0.42);
  gateway.status.mutable_counters()->set_starvation_holds(2);
  gateway.status.set_job_filament_mm(123456);
  for (const auto state : {joblink::STATE_CHECKING, joblink::STATE_RUNNING, joblink::STATE_READY}) {
    gateway.status.set_state(state);
    gateway.status.set_job(state == joblink::STATE_READY ? "" : "a.gcode");
    gateway.status.set_elapsed_s(state == joblink::STATE_READY ? 0 : 45296);
    settle();
  }
  ASSERT_EQ(desk.record.end(), JobRecord::End::kComplete);
  nothing_is_cut();
}

}  // namespace
}  // namespace kinebus::gui
