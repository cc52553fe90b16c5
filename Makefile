# Rugo's one build file. `make run` and `make test` need nothing but make itself: `make deps` fetches the rest.
#   BUILD=dir        where objects go (build)
#   V=1              show each command
#   SAN=address,undefined | SAN=thread   sanitizers      COV=1 coverage      DEBUG=1 no optimisation
#   CI=1             warnings are errors
# CC, AR, CPPFLAGS, CFLAGS, LDFLAGS and LDLIBS are the user's, from the command line or the environment; so are
# DESTDIR, PREFIX, bindir, libdir, includedir, mandir, pythondir and INSTALL_PROGRAM (`install` keeps symbols) of `make install`.
BUILD  ?= build
PREFIX ?= /usr/local
bindir     ?= $(PREFIX)/bin
libdir     ?= $(PREFIX)/lib
includedir ?= $(PREFIX)/include
mandir     ?= $(PREFIX)/share/man
completion ?= $(PREFIX)/share/bash-completion/completions
pythondir  ?= $(PREFIX)/share/rugo/python
INSTALL         ?= install
INSTALL_PROGRAM ?= $(INSTALL) -s
INSTALL_DATA    ?= $(INSTALL) -m 644
OBJCOPY         ?= objcopy

Q      = $(if $(V),,@)
say    = $(if $(V),@:,@echo)

PACKAGES = fftw3 gsl sqlite3 libmicrohttpd libcjson libcurl nettle zlib libpng cmocka
APT      = build-essential pkg-config libfftw3-dev libgsl-dev librandom123-dev libsuitesparse-dev \
           libsqlite3-dev libmicrohttpd-dev libcjson-dev libcurl4-openssl-dev nettle-dev zlib1g-dev libpng-dev \
           libcmocka-dev
# those without a pkg-config file
HEADERS  = Random123/philox.h suitesparse/cholmod.h

MODE     = $(SAN)$(COV)$(DEBUG)
CFLAGS  ?= -g $(if $(SAN),-O1,$(if $(MODE),-O0,-O3)) -fstack-protector-strong \
           $(if $(MODE),,-U_FORTIFY_SOURCE -D_FORTIFY_SOURCE=3)
LDFLAGS ?= -Wl,-z,relro,-z,now

# What the code needs stands before and after the user's flags, whatever these are.
WARN     = -Wall -Wextra -Wpedantic -Wshadow -Wconversion $(if $(CI),-Werror)
TESTED   = $(if $(SAN),-fsanitize=$(SAN)) $(if $(COV),--coverage)
# No contraction and no fast-math: one realisation gives the same digits whatever the vector width.
LANGUAGE = -std=c11 -D_GNU_SOURCE -I.
NEEDED   = $(LANGUAGE) -ffp-contract=off -fno-math-errno -fno-trapping-math -fPIC -fvisibility=hidden -pthread \
           $(TESTED) $(if $(SAN),-fno-omit-frame-pointer -fno-sanitize-recover=all)
COMPILE  = $(CC) $(WARN) $(CPPFLAGS) $(CFLAGS) $(NEEDED)
LINK     = $(CC) $(CFLAGS) $(LDFLAGS) -pthread $(TESTED)
LIBS_core   = -lcholmod -lfftw3 -lgsl -lgslcblas -lm
LIBS_schema = -lcjson -lsqlite3 $(LIBS_core)
LIBS_jobs   = $(LIBS_schema)
LIBS_worker = -lcurl $(LIBS_jobs)
LIBS_server = -lmicrohttpd -lpng -lnettle -lz $(LIBS_worker)

# Files linked in as data: _binary_<path with underscores>_start and _end.
embedded = $(filter %.html %.js %.css %.yaml %.py,$(wildcard $(addprefix $(1)/,web/* web/vendor/* http/* python/*)))
# The migrations of the store as one piece of data in the order of their names, each ended by a NUL.
MIGRATIONS = $(sort $(wildcard schema/store/migrations/*.sql))
DATA_schema = $(BUILD)/schema/store/migrations.data.o
# The ready studies as one JSON list, for the page to begin new ones from.
TEMPLATES = $(sort $(wildcard jobs/studies/*.json))
DATA_server = $(BUILD)/server/web/templates.data.o

# Each layer is an archive; a layer's tests link it and the layers below, so that one can work on one layer alone.
LAYERS   = core schema jobs worker server
BELOW_core   = core
BELOW_schema = schema core
BELOW_jobs   = jobs schema core
BELOW_worker = worker jobs schema core
BELOW_server = server worker jobs schema core
MAIN     = server/command/main.c
sources  = $(filter-out $(MAIN) core/example.c,$(wildcard $(1)/*.c $(1)/*/*.c))
objects  = $(patsubst %,$(BUILD)/%.o,$(1))
archive  = $(patsubst %,$(BUILD)/lib%.a,$(1))

.PHONY: all library deps run test unit faults validation system bench lint format check-format install clean
all: $(BUILD)/rugo library

# Rewritten when the flags change; all that they make depends on it.
export FLAGS = $(COMPILE) / $(LINK) / $(LDLIBS)
$(BUILD)/flags: FORCE
	@mkdir -p $(@D); echo "$$FLAGS" | cmp -s - $@ || echo "$$FLAGS" >$@
FORCE:

# The commit that is built, as a C file that is rewritten when it changes: the program alone links it, so that a commit
# relinks one file. An archive without git, or one unpacked inside another repository, has the commit "unknown".
COMMIT ?= $(shell [ -z "$$(git rev-parse --show-prefix 2>&1)" ] && \
            git describe --always --dirty --abbrev=12 --exclude='*' 2>/dev/null || echo unknown)
$(BUILD)/commit.c: FORCE
	@mkdir -p $(@D); echo 'extern const char PROGRAM_COMMIT[]; const char PROGRAM_COMMIT[] = "$(COMMIT)";' | \
	    cmp -s - $@ || echo 'extern const char PROGRAM_COMMIT[]; const char PROGRAM_COMMIT[] = "$(COMMIT)";' >$@
$(BUILD)/commit.o: $(BUILD)/commit.c $(BUILD)/flags
	$(Q)$(COMPILE) -c $< -o $@

$(BUILD)/%.c.o: %.c $(BUILD)/flags
	@mkdir -p $(@D)
	$(say) CC $<
	$(Q)$(COMPILE) -MMD -MP -c $< -o $@

$(DATA_schema): $(MIGRATIONS) schema/store/migrations
	@mkdir -p $(@D)
	$(Q)for file in $(MIGRATIONS); do cat $$file && printf '\0' || exit; done > $(@D)/migrations.sql
	$(Q)cd $(@D) && $(LD) -r -b binary -z noexecstack migrations.sql -o $(abspath $@)

$(DATA_server): $(TEMPLATES) jobs/studies
	@mkdir -p $(@D)
	$(Q){ between='['; for file in $(TEMPLATES); do echo "$$between"; cat $$file || exit; between=','; done; echo ']'; } \
	    > $(@D)/templates.json
	$(Q)cd $(@D) && $(LD) -r -b binary -z noexecstack templates.json -o $(abspath $@)

$(BUILD)/%.data.o: %
	@mkdir -p $(@D)
	$(Q)$(LD) -r -b binary -z noexecstack $< -o $@

define LAYER
$(BUILD)/lib$(1).a: $(call objects,$(call sources,$(1))) $(patsubst %,$(BUILD)/%.data.o,$(call embedded,$(1))) \
    $(DATA_$(1))
	@mkdir -p $$(@D); rm -f $$@
	$(Q)$(AR) rcs $$@ $$^
endef
$(foreach layer,$(LAYERS),$(eval $(call LAYER,$(layer))))

$(BUILD)/rugo: $(call objects,$(MAIN)) $(BUILD)/commit.o $(call archive,$(BELOW_server))
	$(say) LD $@
	$(Q)$(LINK) -pie -o $@ $^ $(LIBS_server) $(LDLIBS)

# The library: core, with the functions of rugo.h alone to be seen from outside.
VERSION  := $(shell sed -n 's/^.define RUGO_VERSION "\(.*\)"/\1/p' core/rugo.h)
SONAME    = librugo.so.$(basename $(VERSION))
SHARED    = librugo.so.$(VERSION)
library: $(addprefix $(BUILD)/,$(SHARED) librugo.a rugo.pc rugo.1 rugo.bash)

$(BUILD)/$(SHARED): $(call objects,$(call sources,core)) core/rugo.map
	$(say) LD $@
	$(Q)$(LINK) -shared -Wl,-soname,$(SONAME) $(if $(SAN),,-Wl,-z,defs) \
	    -o $@ $(filter %.o,$^) -Wl,--version-script=core/rugo.map $(LIBS_core) $(LDLIBS)

$(BUILD)/librugo.a: $(call objects,$(call sources,core))
	$(Q)$(LD) -r -o $(BUILD)/librugo.o $^
	$(Q)$(OBJCOPY) --wildcard --keep-global-symbol='rugo_*' -R '.gnu.lto_*' -N '*.c.*' $(BUILD)/librugo.o
	$(Q)rm -f $@; $(AR) rcs $@ $(BUILD)/librugo.o

$(BUILD)/rugo.pc: core/rugo.pc.in FORCE
	@sed -e 's|@PREFIX@|$(PREFIX)|; s|@libdir@|$(libdir)|; s|@includedir@|$(includedir)|; s|@VERSION@|$(VERSION)|' $< >$@
$(BUILD)/rugo.1: $(BUILD)/rugo
	@$< help man >$@
$(BUILD)/rugo.bash: $(BUILD)/rugo
	@$< help bash >$@

# Tests: tests/<ladder>/<layer>/<name>.c is a program; tests/*.c are shared by all of them.
SUPPORT = $(call objects,$(wildcard tests/support/*.c))
define TESTS
TESTS_$(1)_$(2) = $(patsubst %.c,$(BUILD)/%,$(wildcard tests/$(1)/$(2)/*.c))
$$(TESTS_$(1)_$(2)): $(BUILD)/%: $(BUILD)/%.c.o $(SUPPORT) $(call archive,$(BELOW_$(2)))
	$(say) LD $$@
	$(Q)$(LINK) -pie -o $$@ $$^ -lcmocka $(LIBS_$(2)) $(LDLIBS)
$(1)-$(2): $$(TESTS_$(1)_$(2))
	tests/run-tests $$^
.PHONY: $(1)-$(2)
endef
LADDERS = unit faults fuzz validation system bench
$(foreach ladder,$(LADDERS),$(foreach layer,$(LAYERS),$(eval $(call TESTS,$(ladder),$(layer)))))
all_tests = $(foreach layer,$(LAYERS),$(TESTS_$(1)_$(layer)))

test: deps
	@$(MAKE) --no-print-directory -j$$(nproc) run-tests-built
.PHONY: run-tests-built browser
# The ladders with long programs come first, so that no processor waits for one in the end.
EVERY_TEST = $(foreach ladder,validation faults system unit fuzz,$(call all_tests,$(ladder)))
run-tests-built: all $(EVERY_TEST)
	@RUGO=$(abspath $(BUILD))/rugo tests/run-tests $(EVERY_TEST)
	@tests/browser/run $(abspath $(BUILD))/rugo
browser: all
	@tests/browser/run $(abspath $(BUILD))/rugo
unit faults validation system: all
	@$(MAKE) --no-print-directory $(call all_tests,$@)
	@RUGO=$(abspath $(BUILD))/rugo tests/run-tests $(call all_tests,$@)

# Faults: every allocation of a test program, and of the program itself, fails in turn; a hook is linked in.
FAILING = $(patsubst %,$(BUILD)/tests/support/failing/%.c.o,failing_allocator each_allocation)
HOOK    = $(patsubst %,$(BUILD)/tests/support/failing/%.c.o,failing_allocator failing_environment)
$(call all_tests,faults): $(FAILING)
$(TESTS_faults_server): | $(BUILD)/rugo-failing
$(BUILD)/rugo-failing: $(call objects,$(MAIN)) $(HOOK) $(call archive,$(BELOW_server))
	$(say) LD $@
	$(Q)$(LINK) -pie -o $@ $^ $(LIBS_server) $(LDLIBS)
# Under sanitizers: without whole commands, where the sanitizer itself and OpenSSL's set-up do not take a failure.
run-faults:
	@$(MAKE) --no-print-directory -j$$(nproc) $(filter-out $(TESTS_faults_server),$(call all_tests,faults))
	@tests/run-tests $(filter-out $(TESTS_faults_server),$(call all_tests,faults))
.PHONY: run-faults

# Fuzzing: a target of tests/fuzz/<layer> is a test that replays its corpus (tests/support/fuzz), and with clang's
# libFuzzer in a build of its own it runs for SECONDS, beginning with its corpus. What it finds stays in $(BUILD)-fuzz.
SECONDS = 60
REPLAY  = $(BUILD)/tests/support/fuzz/replay.c.o
$(call all_tests,fuzz): $(REPLAY)
fuzz: fuzz-deps
	@$(MAKE) --no-print-directory BUILD=$(BUILD)-fuzz CC=clang SAN=address,undefined,fuzzer-no-link run-fuzz
fuzz-deps: deps
	@tests/install-deps "" "clang libclang-rt-dev" clang
define FUZZ
$(BUILD)/fuzz/$(notdir $(1)): $(1).c.o $(call archive,$(BELOW_server))
	@mkdir -p $$(@D)
	$(say) LD $$@
	$(Q)$(LINK) -fsanitize=fuzzer -pie -o $$@ $$^ $(LIBS_server) $(LDLIBS)
run-fuzz-$(notdir $(1)): $(BUILD)/fuzz/$(notdir $(1))
	@mkdir -p $$<.corpus
	@cd $$(<D) && ./$$(<F) -max_total_time=$(SECONDS) -timeout=20 -rss_limit_mb=4096 -max_len=8192 -close_fd_mask=2 \
	    -verbosity=0 -print_final_stats=1 $$(<F).corpus $(abspath tests/fuzz/corpus)/$$(<F) >$$(<F).log 2>&1 || \
	    { tail -n 60 $$(<F).log; exit 1; }
	@sed -n 's/^stat::number_of_executed_units: */fuzz $$(<F): executions /p' $$<.log
.PHONY: run-fuzz-$(notdir $(1))
endef
$(foreach target,$(call all_tests,fuzz),$(eval $(call FUZZ,$(target))))
run-fuzz: $(foreach target,$(call all_tests,fuzz),run-fuzz-$(notdir $(target)))
.PHONY: fuzz fuzz-deps run-fuzz

# Under sanitizers: all unit tests, or (for SAN=thread) those of the layers that own threads.
run-unit:
	@$(MAKE) --no-print-directory -j$$(nproc) $(call all_tests,unit)
	@tests/run-tests $(call all_tests,unit)
run-threads:
	@$(MAKE) --no-print-directory -j$$(nproc) all $(TESTS_unit_worker) $(TESTS_system_server)
	@TSAN_OPTIONS=suppressions=$(abspath tests/thread-sanitizer.txt) \
		RUGO=$(abspath $(BUILD))/rugo tests/run-tests $(TESTS_unit_worker) $(TESTS_system_server)
.PHONY: run-unit run-threads

deps:
	@CC="$(CC) $(CPPFLAGS)" tests/install-deps "$(PACKAGES)" "$(APT)" $(firstword $(CC)) pkg-config $(HEADERS)

run: deps
	@$(MAKE) --no-print-directory -j$$(nproc) all
	@for study in demo contact-demo; do \
	    $(BUILD)/rugo run --db $(BUILD)/demo.db jobs/studies/$$study.json || exit; echo; done

bench: deps
	@$(MAKE) --no-print-directory -j$$(nproc) all $(call all_tests,bench)
	@RUGO=$(abspath $(BUILD))/rugo tests/bench/run $(call all_tests,bench)

SOURCES = $(shell git ls-files --cached --others --exclude-standard '*.c' '*.h')
format:
	@clang-format -i $(SOURCES)
check-format:
	@clang-format --dry-run --Werror $(SOURCES)
lint: lint-deps check-format check-layers check-circles check-citations
	@printf '%s\n' $(filter %.c,$(SOURCES)) | \
	    xargs -P $$(nproc) -I {} bash -o pipefail -c \
	        "clang-tidy --quiet {} -- $(LANGUAGE) -Icore 2>&1 | sed '/^[0-9]* warnings* generated/d'"
	@echo "lint: $(words $(filter %.c,$(SOURCES))) files clean"
lint-deps: deps
	@tests/install-deps "" "clang-format clang-tidy" clang-format clang-tidy
.PHONY: lint-deps

# What comments and documents cite is there, and the check of it notices what is not.
check-citations:
	@tests/check-citations --self-test
	@tests/check-citations
	@echo "citations: all found"

# The pictures of the documents, drawn by the program; CI checks that they are what it draws today.
FIGURES = jobs/studies/figures
figures: all
	@$(FIGURES)/draw $(BUILD)/rugo $(FIGURES)
page-figures: all
	@tests/browser/run $(abspath $(BUILD))/rugo $(FIGURES)
check-figures: all
	@tests/same-figures --self-test
	@$(FIGURES)/draw $(BUILD)/rugo $(BUILD)/figures
	@tests/same-figures $(FIGURES) $(BUILD)/figures
	@echo "figures: as the program draws them"
.PHONY: check-citations figures page-figures check-figures

# The description of the HTTP service, by a linter from npm; skipped where there is none.
check-openapi: all
	@tests/lint-openapi $(abspath $(BUILD)/rugo)
.PHONY: check-openapi

# Each archive needs nothing but those of the layers below it: linked whole, it leaves no symbol open.
define WHOLE
$(BUILD)/whole-$(1): $(call archive,$(BELOW_$(1)))
	$(Q)echo 'int main(void) { return 0; }' | $(LINK) -o $$@ -x c - -x none \
	    -Wl,--whole-archive $(BUILD)/lib$(1).a -Wl,--no-whole-archive $$^ $(LIBS_$(1)) $(LDLIBS)
endef
$(foreach layer,$(LAYERS),$(eval $(call WHOLE,$(layer))))
check-layers: $(patsubst %,$(BUILD)/whole-%,$(LAYERS))
	@echo "layers: $(LAYERS): each links whole against those below"

# No file includes itself by way of others, and the check of it notices one that does.
check-circles:
	@tests/check-circles --self-test
	@tests/check-circles
.PHONY: check-layers check-circles

INSTALLED = $(bindir)/rugo $(libdir)/$(SHARED) $(libdir)/$(SONAME) $(libdir)/librugo.so $(libdir)/librugo.a \
            $(libdir)/pkgconfig/rugo.pc $(includedir)/rugo.h $(mandir)/man1/rugo.1 $(completion)/rugo \
            $(pythondir)/rugo.py
install: all
	$(INSTALL) -d $(sort $(dir $(addprefix $(DESTDIR),$(INSTALLED))))
	$(INSTALL_PROGRAM) $(BUILD)/rugo $(DESTDIR)$(bindir)/rugo
	$(INSTALL_PROGRAM) -m 644 $(BUILD)/$(SHARED) $(DESTDIR)$(libdir)/$(SHARED)
	ln -sf $(SHARED) $(DESTDIR)$(libdir)/$(SONAME)
	ln -sf $(SONAME) $(DESTDIR)$(libdir)/librugo.so
	$(INSTALL_DATA) $(BUILD)/librugo.a $(DESTDIR)$(libdir)/librugo.a
	$(INSTALL_DATA) $(BUILD)/rugo.pc $(DESTDIR)$(libdir)/pkgconfig/rugo.pc
	$(INSTALL_DATA) core/rugo.h $(DESTDIR)$(includedir)/rugo.h
	$(INSTALL_DATA) $(BUILD)/rugo.1 $(DESTDIR)$(mandir)/man1/rugo.1
	$(INSTALL_DATA) $(BUILD)/rugo.bash $(DESTDIR)$(completion)/rugo
	$(INSTALL_DATA) server/python/rugo.py $(DESTDIR)$(pythondir)/rugo.py
uninstall:
	rm -f $(addprefix $(DESTDIR),$(INSTALLED))

# Into a prefix of its own: header, libraries and pkg-config agree, and the example runs with each library.
check-install: all
	@CC="$(CC)" MAKE="$(MAKE) --no-print-directory BUILD=$(BUILD)" tests/check-install core/example.c
.PHONY: uninstall check-install
clean:
	rm -rf $(BUILD) $(dir $(wildcard build*/flags))

-include $(shell find $(BUILD) -name '*.d' 2>/dev/null)
