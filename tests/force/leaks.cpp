// For the leak sanitizer, which calls this: OpenMM loses what it has built so far when a Context's constructor throws.
// NOLINTBEGIN(bugprone-reserved-identifier,readability-identifier-naming): the sanitizer's name
extern "C" char const* __lsan_default_suppressions();
extern "C" char const* __lsan_default_suppressions() { return "leak:OpenMM::Context::Context\n"; }
// NOLINTEND(bugprone-reserved-identifier,readability-identifier-naming)
