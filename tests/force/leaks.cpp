// For the leak sanitizer, which calls this: OpenMM loses what it has built so far when a Context's
// constructor or the reader of a damaged System throws. What Catena itself makes and loses is still
// reported, since its own code is on top of that stack.
// NOLINTBEGIN(bugprone-reserved-identifier,readability-identifier-naming): the sanitizer's name
extern "C" char const* __lsan_default_suppressions();
extern "C" char const* __lsan_default_suppressions() { return "leak:libOpenMM\n"; }
// NOLINTEND(bugprone-reserved-identifier,readability-identifier-naming)
