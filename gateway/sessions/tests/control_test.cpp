// Who may command the machine: one at a time, and only who is here.

#include "gateway/sessions/control.hpp"

#include <gtest/gtest.h>

namespace kinebus {
namespace {

class ControlTest : public ::testing::Test {
 protected:
  Control control_;
  ClientId anna_ = control_.attach("anna", "usb"), bert_ = control_.attach("bert", "local");
};

TEST_F(ControlTest, NobodyCannotCommandNorTakeControlByForce) {
  EXPECT_FALSE(control_.may_command(0));
  EXPECT_FALSE(control_.take(0, true));
  EXPECT_EQ(control_.holder(), 0U);
}

TEST_F(ControlTest, ItIsKeptUntilItIsReleasedByItsHolderOrTakenByForce) {
  EXPECT_TRUE(control_.may_command(anna_));
  EXPECT_TRUE(control_.may_command(anna_)) << "again";
  EXPECT_FALSE(control_.may_command(bert_));
  control_.release(bert_);
  EXPECT_EQ(control_.holder(), anna_) << "only its holder releases it";
  EXPECT_TRUE(control_.take(bert_, true));
  control_.detach(anna_);
  EXPECT_EQ(control_.holder(), bert_) << "who goes without control takes none along";
  control_.release(bert_);
  EXPECT_EQ(control_.holder(), 0U);
}

TEST_F(ControlTest, ItIsHandedOverByItsHolderAloneToAClientThatIsHere) {
  EXPECT_FALSE(control_.hand_over(0, bert_)) << "nobody has it, and nobody gives it";
  ASSERT_TRUE(control_.take(anna_, false));
  EXPECT_FALSE(control_.hand_over(bert_, bert_)) << "it is not bert's";
  for (const ClientId nobody : {ClientId{0}, ClientId{77}}) EXPECT_FALSE(control_.hand_over(anna_, nobody));
  EXPECT_EQ(control_.holder(), anna_);
  EXPECT_TRUE(control_.hand_over(anna_, bert_));
  control_.detach(anna_);
  EXPECT_FALSE(control_.hand_over(bert_, anna_)) << "she has gone";
  EXPECT_EQ(control_.holder(), bert_);
}

TEST_F(ControlTest, ClientsAreThoseThatAreHereUnderTheirNames) {
  EXPECT_EQ(control_.name_of(bert_), "bert");
  EXPECT_EQ(control_.name_of(77), "");
  control_.detach(anna_);
  ASSERT_EQ(control_.clients().size(), 1U);
  EXPECT_EQ(control_.clients()[0].id, bert_);
  EXPECT_EQ(control_.clients()[0].transport, "local");
  EXPECT_EQ(control_.attach("carl", "local"), bert_ + 1) << "no number comes twice";
}

}  // namespace
}  // namespace kinebus
