#include "db/sqlite.h"
#include "tests/db/temp_store.h"

namespace ramcdb::db::test {
namespace {

constexpr std::int64_t kSecond = 1'000'000, kHour = 3600 * kSecond, kNow = 1'800'000'000 * kSecond;

std::vector<ChartId> charts(std::initializer_list<std::uint32_t> numbers) {
  std::vector<ChartId> ids;
  for (const std::uint32_t n : numbers) ids.emplace_back(n);
  return ids;
}

ChartLock wish(const std::string& owner, std::vector<ChartId> ids, std::int64_t taken = kNow,
               std::int64_t lasts = kHour) {
  return {0, MeshId(1), std::move(ids), owner, "why", "main", taken, taken + lasts};
}

class Locks : public ::testing::Test {
 protected:
  [[nodiscard]] std::vector<ChartLock> against(const std::string& owner, const std::vector<ChartId>& ids,
                                               std::int64_t now = kNow, MeshId mesh = MeshId(1)) {
    return store_->locks_against(mesh, ids, owner, now);
  }

  TempStore temp_;
  std::shared_ptr<Store> store_ = temp_.open();
};

TEST_F(Locks, AreInTheWayOfOthersOnlyAndOnTheirChartsOnly) {
  const auto taken = store_->lock(wish("ada", charts({3, 4, 9})), false);
  EXPECT_TRUE(taken.done);
  EXPECT_EQ(taken.lock.id, 1U);
  ChartLock expected = wish("ada", charts({3, 4, 9}));
  expected.id = 1;
  EXPECT_EQ(store_->locks(kNow), std::vector{expected});
  EXPECT_TRUE(against("ada", charts({3, 4, 9})).empty());
  EXPECT_TRUE(against("bob", charts({1, 2, 5})).empty());
  EXPECT_TRUE(against("bob", charts({3}), kNow, MeshId(2)).empty());
  expected.charts = charts({4, 9});
  EXPECT_EQ(against("bob", charts({4, 5, 9})), std::vector{expected});
  store_.reset();
  EXPECT_EQ(temp_.open(Access::read)->locks(kNow).size(), 1U) << "durable";
  EXPECT_EQ(problems(*temp_.open()), std::vector<std::string>{});
}

TEST_F(Locks, AreNotTakenOverOthersUnlessStolen) {
  (void)store_->lock(wish("ada", charts({1, 2, 3})), false);
  const auto refused = store_->lock(wish("bob", charts({3, 4})), false);
  EXPECT_FALSE(refused.done);
  ASSERT_EQ(refused.others.size(), 1U);
  EXPECT_EQ(refused.others[0].owner, "ada");
  EXPECT_EQ(refused.others[0].charts, charts({3}));
  EXPECT_EQ(store_->locks(kNow).size(), 1U);

  const auto stolen = store_->lock(wish("bob", charts({3, 4})), true);
  EXPECT_TRUE(stolen.done);
  EXPECT_EQ(stolen.others, refused.others);
  ASSERT_EQ(store_->locks(kNow).size(), 2U);
  EXPECT_EQ(store_->locks(kNow)[0].charts, charts({1, 2})) << "ada keeps the rest";
  EXPECT_EQ(against("ada", charts({1, 2, 3}))[0].charts, charts({3}));
  EXPECT_TRUE(store_->lock(wish("cy", charts({1, 2})), true).done);
  for (const ChartLock& lock : store_->locks(kNow)) EXPECT_NE(lock.owner, "ada") << "nothing is left of it";
}

TEST_F(Locks, OfOneOwnerMayOverlapAndEndApart) {
  const auto first = store_->lock(wish("ada", charts({1, 2})), false);
  const auto second = store_->lock(wish("ada", charts({2, 3})), false);
  EXPECT_TRUE(second.done);
  EXPECT_TRUE(second.others.empty());
  EXPECT_EQ(store_->unlock({second.lock.id, {}, {}}, "ada", false, kNow).released.size(), 1U);
  EXPECT_EQ(against("bob", charts({1, 2, 3}))[0].charts, charts({1, 2}));
  EXPECT_EQ(first.lock.id, 1U);
  EXPECT_EQ(store_->lock(wish("ada", charts({7})), false).lock.id, 3U) << "an id is not used twice";
}

TEST_F(Locks, ExpireAndAreSweptByTheNextWriter) {
  (void)store_->lock(wish("ada", charts({1})), false);
  EXPECT_EQ(against("bob", charts({1}), kNow + kHour - 1).size(), 1U);
  EXPECT_TRUE(against("bob", charts({1}), kNow + kHour).empty());
  EXPECT_TRUE(store_->locks(kNow + kHour).empty());
  EXPECT_TRUE(store_->lock(wish("bob", charts({1}), kNow + kHour), false).done);
  EXPECT_EQ(store_->locks(0).size(), 1U) << "ada's is gone";

  // One that ended long before the clock of this machine goes with any commit; one that ends later stays.
  (void)store_->lock(wish("cy", charts({5}), kSecond, kSecond), false);
  (void)store_->lock(wish("dan", charts({6}), kSecond, 9'000'000'000 * kSecond), false);
  (void)publish(*store_, {make_blob(Kind::chart, 1, 100)});
  const auto left = store_->locks(0);
  EXPECT_TRUE(std::none_of(left.begin(), left.end(), [](const ChartLock& l) { return l.owner == "cy"; }));
  EXPECT_TRUE(std::any_of(left.begin(), left.end(), [](const ChartLock& l) { return l.owner == "dan"; }));
}

TEST_F(Locks, OneFromAClockFarAheadCanBeStolen) {
  (void)store_->lock(wish("ada", charts({1}), kNow + 200'000 * kHour, 200'000 * kHour), false);
  EXPECT_FALSE(store_->lock(wish("bob", charts({1})), false).done);
  EXPECT_TRUE(store_->lock(wish("bob", charts({1})), true).done);
  EXPECT_TRUE(against("bob", charts({1})).empty());
}

TEST_F(Locks, AreGivenBackByTheirOwnersOrByForce) {
  (void)store_->lock(wish("ada", charts({1, 2, 3})), false);
  (void)store_->lock(wish("bob", charts({4, 5})), false);
  const LockSelection some{0, MeshId(1), charts({3, 4})};
  auto result = store_->unlock(some, "ada", false, kNow);
  EXPECT_TRUE(result.released.empty()) << "4 is bob's: nothing is changed";
  ASSERT_EQ(result.others.size(), 1U);
  EXPECT_EQ(result.others[0].charts, charts({4}));
  result = store_->unlock(some, "ada", true, kNow);
  EXPECT_EQ(result.released.size(), 2U);
  EXPECT_EQ(store_->locks(kNow)[0].charts, charts({1, 2}));
  EXPECT_EQ(store_->locks(kNow)[1].charts, charts({5}));

  EXPECT_EQ(store_->unlock({2, {}, {}}, "ada", false, kNow).others.size(), 1U);
  EXPECT_TRUE(store_->unlock({77, {}, {}}, "ada", true, kNow).released.empty());
  EXPECT_EQ(store_->unlock({}, "ada", false, kNow).released.size(), 1U) << "all of ada's";
  EXPECT_EQ(store_->locks(kNow).size(), 1U);
  EXPECT_EQ(store_->unlock({}, "ada", true, kNow).released.size(), 1U) << "everybody's";
  EXPECT_TRUE(store_->locks(kNow).empty());
}

TEST_F(Locks, WithoutChartsOwnerOrTimeAreNone) {
  for (const ChartLock& none : {wish("ada", {}), wish("", charts({1})), wish("ada", charts({1}), kNow, 0)})
    expect_error(Errc::invalid_argument, "a lock needs", [&] { (void)store_->lock(none, true); });
}

TEST_F(Locks, ADamagedOneIsFoundAndStopsNobody) {
  for (const char* bytes : {"x''", "x'80'", "x'8182028201'", "x'81820180'"}) {
    (void)store_->lock(wish("ada", charts({1, 2})), false);
    store_.reset();
    Database(temp_ / "catalogue.sqlite", Database::Mode::write).run(std::string("UPDATE lock SET charts = ") + bytes);
    store_ = temp_.open();
    EXPECT_TRUE(against("bob", charts({1, 2})).empty()) << bytes;
    EXPECT_FALSE(problems(*store_).empty()) << bytes;
    EXPECT_EQ(store_->unlock({store_->locks(kNow)[0].id, {}, {}}, "bob", true, kNow).released.size(), 1U);
    EXPECT_TRUE(problems(*store_).empty()) << bytes;
  }
}

}  // namespace
}  // namespace ramcdb::db::test
