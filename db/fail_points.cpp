#include "db/fail_points.h"

namespace ramcdb::db {
namespace {

FailHook& hook() {
  static FailHook installed;
  return installed;
}

}  // namespace

void set_fail_hook(FailHook new_hook) { hook() = std::move(new_hook); }

void fail_point(std::string_view name) {
  if (hook()) hook()(name);
}

}  // namespace ramcdb::db
