# Rugo's one build file. `make run` and `make test` need nothing but make itself: `make deps` fetches the rest.
#   BUILD=dir        where objects go (build)
#   V=1              show each command
#   SAN=address,undefined | SAN=thread   sanitizers      COV=1 coverage      DEBUG=1 no optimisation
#   CI=1             warnings are errors
# CC, AR, CPPFLAGS, CFLAGS, LDFLAGS and LDLIBS are the user's, from the command line or the environment; so are DESTDIR,
# PREFIX, bindir and the folders below it, and INSTALL_PROGRAM (`install` keeps symbols) of `make install`.
BUILD  ?= build
PREFIX ?= /usr/local
bindir     ?= $(PREFIX)/bin
libdir     ?= $(PREFIX)/lib
includedir ?= $(PREFIX)/include
mandir     ?= $(PREFIX)/share/man
completion ?= $(PREFIX)/share/bash-completion/completions
pythondir  ?= $(PREFIX)/share/rugo/python
unitdir    ?= $(PREFIX)/lib/systemd/system
sysusersdir ?= $(PREFIX)/lib/sysusers.d
INSTALL         ?= install
INSTALL_PROGRAM ?= $(INSTALL) -s
INSTALL_DATA    ?= $(INSTALL) -m 644
OBJCOPY         ?= objcopy

Q      = $(if $(V),,@)
say    = $(if $(V),@:,@echo)

PACKAGES = fftw3 gsl sqlite3 libmicrohttpd libcjson libcurl gnutls nettle zlib libpng libzip expat cmocka
APT      = build-essential pkg-config libfftw3-dev libgsl-dev librandom123-dev libsuitesparse-dev \
           libsqlite3-dev libmicrohttpd-dev libcjson-dev libcurl4-openssl-dev libgnutls28-dev nettle-dev zlib1g-dev libpng-dev \
           libzip-dev libexpat1-dev libcmocka-dev
# those without a pkg-config file
HEADERS  = Random123/philox.h suitesparse/cholmod.h suitesparse/umfpack.h

MODE     = $(SAN)$(COV)$(DEBUG)
# That of core, which computes; other layers and tests have theirs below.
LEVEL    = $(if $(SAN),-O2,$(if $(MODE),-O0,-O3))
SYMBOLS  = -g
CFLAGS  ?= $(SYMBOLS) $(LEVEL) -fstack-protector-strong \
           $(if $(MODE),,-U_FORTIFY_SOURCE -D_FORTIFY_SOURCE=3)
LDFLAGS ?= -Wl,-z,relro,-z,now

# What the code needs stands before and after the user's flags, whatever these are.
WARN     = -Wall -Wextra -Wpedantic -Wshadow -Wconversion $(if $(CI),-Werror)
TESTED   = $(if $(SAN),-fsanitize=$(SAN) -DRUGO_SANITIZED) $(if $(COV),--coverage)
# No contraction and no fast-math: one realisation gives the same digits whatever the vector width.
LANGUAGE = -std=c11 -D_GNU_SOURCE -I.
NEEDED   = $(LANGUAGE) -ffp-contract=off -fno-math-errno -fno-trapping-math -fPIC -fvisibility=hidden -pthread \
           $(TESTED) $(if $(SAN),-fno-omit-frame-pointer -fno-sanitize-recover=all)
COMPILE  = $(CC) $(WARN) $(CPPFLAGS) $(CFLAGS) $(NEEDED)
LINK     = $(CC) $(CFLAGS) $(LDFLAGS) -pthread $(TESTED)
LIBS_library = -lumfpack -lcholmod -lfftw3 -lgsl -lgslcblas -lm
LIBS_core   = -lzip -lz -lexpat -lnettle $(LIBS_library)
LIBS_schema = -lcjson -lsqlite3 $(LIBS_core)
LIBS_jobs   = $(LIBS_schema)
LIBS_worker = -lcurl $(LIBS_jobs)
LIBS_server = -lmicrohttpd -lgnutls -lpng $(LIBS_worker)

# Files linked in as data: _binary_<path with underscores>_start and _end.
embedded = $(filter %.html %.js %.css %.yaml %.py,$(wildcard $(addprefix $(1)/,web/* web/vendor/* http/* python/rugo/client.py)))
# The migrations of the store as one block of data in the order of their names, each ended by a NUL.
MIGRATIONS = $(sort $(wildcard schema/store/migrations/*.sql))
DATA_schema = $(BUILD)/schema/store/migrations.data.o
# What all of them make of an empty file, likewise ended by a NUL.
LAYOUT   = schema/store/layout.sql
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
sources  = $(filter-out $(MAIN) core/example.c,$(wildcard $(1)/*.c $(1)/*/*.c $(1)/*/*/*.c $(1)/*/*/*/*.c))
objects  = $(patsubst %,$(BUILD)/%.o,$(1))
archive  = $(patsubst %,$(BUILD)/lib%.a,$(1))

.PHONY: all library deps run test unit faults validation system bench lint format check-format install clean
all: $(BUILD)/rugo library

# Rewritten when the flags change; all that they make depends on it. With new flags, or in a new folder, the compiler is
# first asked for all headers that the code includes.
export FLAGS = $(COMPILE) / $(LINK) / $(LDLIBS)
$(BUILD)/flags: FORCE
	@mkdir -p $(@D); echo "$$FLAGS" | cmp -s - $@ || { \
	    missing=$$(grep -rh --include='*.[ch]' --exclude=example.c '^#include <' $(LAYERS) | sort -u | \
	        $(COMPILE) -E -x c - 2>&1 >/dev/null | sed -n '/fatal error\|not found/ { s/.*fatal error: //; p; q; }'); \
	    [ -z "$$missing" ] || { echo "$$missing; make deps installs what is missing" >&2; exit 1; }; \
	    echo "$$FLAGS" >$@; }
FORCE:

# The commit that is built, as a C file that is rewritten when it changes: the program alone links it, so that a commit
# relinks one file. An archive of git has it in .commit; another copy without git, or one unpacked inside another
# repository, has the commit "unknown".
COMMIT ?= $(shell [ -z "$$(git rev-parse --show-prefix 2>&1)" ] && \
            git describe --always --dirty --abbrev=12 --exclude='*' 2>/dev/null || \
            sed -n 's/^\([0-9a-f]\{12\}\)[0-9a-f]\{28\}$$/\1/p' .commit 2>/dev/null | grep . || echo unknown)
$(BUILD)/commit.c: FORCE
	@mkdir -p $(@D); echo 'extern const char PROGRAM_COMMIT[]; const char PROGRAM_COMMIT[] = "$(COMMIT)";' | \
	    cmp -s - $@ || echo 'extern const char PROGRAM_COMMIT[]; const char PROGRAM_COMMIT[] = "$(COMMIT)";' >$@
$(BUILD)/commit.o: $(BUILD)/commit.c $(BUILD)/flags
	$(Q)$(COMPILE) -c $< -o $@

# Layers above core are compiled in four fifths of the time, under clang's sanitizers in a quarter; jobs computes, too.
# Without optimisation gcc cannot see which texts are cut short on purpose, and warns.
LEVEL_OF = $(if $(MODE),$(if $(SAN),$(if $(findstring clang,$(CC)),-O0,-O2),-O0),$(1))
$(foreach layer,schema worker server,$(eval $(BUILD)/$(layer)/%.c.o: private LEVEL = $$(call LEVEL_OF,-O2)))
$(BUILD)/jobs/%.c.o: private LEVEL = $(call LEVEL_OF,-O3)

# What computes reads no input: coverage of its loops guides no fuzzer, and takes a third of the time under sanitizers.
COMPUTES = core/contact core/full core/quantity core/statistics core/surface core/theory
$(if $(findstring fuzzer-no-link,$(SAN)),$(foreach folder,$(COMPUTES),$(eval \
    $(BUILD)/$(folder)/%.c.o: private UNGUIDED = -fno-sanitize=fuzzer-no-link)))

$(BUILD)/%.c.o: %.c $(BUILD)/flags
	@mkdir -p $(@D)
	$(say) CC $<
	$(Q)$(COMPILE) $(UNGUIDED) -MMD -MP -c $< -o $@

$(DATA_schema): $(MIGRATIONS) $(LAYOUT) schema/store/migrations
	@mkdir -p $(@D)
	$(Q)for file in $(MIGRATIONS); do cat $$file && printf '\0' || exit; done > $(@D)/migrations.sql
	$(Q){ cat $(LAYOUT) && printf '\0'; } > $(@D)/layout.sql
	$(Q)cd $(@D) && $(LD) -r -b binary -z noexecstack migrations.sql layout.sql -o $(abspath $@)

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

# The program without shared libraries, for machines that have none of them or older ones. Its libraries are made from
# the distribution's sources where Debian has no archives of them (server/static/libraries).
STATIC      = $(BUILD)/static
LIBS_static = -lmicrohttpd -lpng -lcurl -lssl -lcrypto -lcjson -lsqlite3 -lumfpack -lcholmod -lamd -lcamd -lcolamd -lccolamd \
              -lsuitesparseconfig -lmetis -llapack -lblas -lgfortran -lquadmath -lgomp -lfftw3 -lgsl -lgslcblas -lgnutls \
              -ltasn1 -lhogweed -lnettle -lgmp -lunistring -lzip -lexpat -lz -lm
static: static-deps
	@$(MAKE) --no-print-directory $(STATIC)/rugo
static-deps: deps
	@CC="$(CC)" tests/install-deps "libssl gnutls nettle" "libssl-dev libgnutls28-dev libunistring-dev dpkg-dev gfortran cmake" \
	    unistring/version.h dpkg-source gfortran cmake
$(STATIC)/libraries: server/static/libraries
	@mkdir -p $(@D)
	@CC="$(CC)" $< $(STATIC) && touch $@
# The linker warns of name lookups and dlopen, which server/command/portable.c keeps from other C libraries.
$(STATIC)/rugo: $(call objects,$(MAIN)) $(BUILD)/commit.o $(call archive,$(BELOW_server)) $(STATIC)/libraries
	$(say) LD $@
	$(Q)$(LINK) -static-pie -Wl,--gc-sections,-s -o $@ $(filter %.o %.a,$^) -L$(STATIC)/lib \
	    -Wl,--start-group $(LIBS_static) -Wl,--end-group $(LDLIBS) >$@.log 2>&1 || { cat $@.log; exit 1; }
# In a folder with nothing but the program as the root of its files; skipped, with a word, where that cannot be made.
check-static: all
	@MAKE="$(MAKE) --no-print-directory" tests/check-static $(abspath $(BUILD)) $(abspath $(STATIC)/rugo)
.PHONY: static static-deps check-static

# The library: core, with the functions of rugo.h alone to be seen from outside. They read no files of instruments: those
# who link it need neither zip nor XML.
VERSION  := $(shell sed -n 's/^.define RUGO_VERSION "\(.*\)"/\1/p' core/rugo.h)
SONAME    = librugo.so.$(basename $(VERSION))
SHARED    = librugo.so.$(VERSION)
LIBRARY   = $(call objects,$(filter-out core/instrument/% core/nodal/%,$(call sources,core)))
library: $(addprefix $(BUILD)/,$(SHARED) librugo.a rugo.pc rugo.1 rugo.bash)

$(BUILD)/$(SHARED): $(LIBRARY) core/rugo.map
	$(say) LD $@
	$(Q)$(LINK) -shared -Wl,-soname,$(SONAME) $(if $(SAN),,-Wl,-z,defs) \
	    -o $@ $(filter %.o,$^) -Wl,--version-script=core/rugo.map $(LIBS_library) $(LDLIBS)

$(BUILD)/librugo.a: $(LIBRARY)
	$(Q)$(LD) -r -o $(BUILD)/librugo.o $^
	$(Q)$(OBJCOPY) --wildcard --keep-global-symbol='rugo_*' -R '.gnu.lto_*' -N '*.c.*' $(BUILD)/librugo.o
	$(Q)rm -f $@; $(AR) rcs $@ $(BUILD)/librugo.o

$(BUILD)/rugo.pc: core/rugo.pc.in FORCE
	@sed -e 's|@PREFIX@|$(PREFIX)|; s|@libdir@|$(libdir)|; s|@includedir@|$(includedir)|; s|@VERSION@|$(VERSION)|' $< >$@
$(BUILD)/rugo.1: $(BUILD)/rugo
	@$< help man >$@
$(BUILD)/rugo.bash: $(BUILD)/rugo
	@$< help bash >$@

# Tests: tests/<ladder>/<layer>/[<room>/]<name>.c is a program; tests/support/*.c are shared by all of them. They
# compute little themselves, and are compiled in half of the time; all are linked by gold in half of it, where there is one. It
# warns of hundreds of symbols of clang's sanitizers, with which lld takes a quarter.
$(foreach folder,support system faults fuzz unit validation,$(eval \
    $(BUILD)/tests/$(folder)/%.c.o: private LEVEL = $$(call LEVEL_OF,-O1)) \
    $(eval $(BUILD)/tests/$(folder)/%.c.o: private SYMBOLS = -g1))
LINKER := $(if $(SAN),$(if $(shell command -v ld.lld),-fuse-ld=lld),$(if $(shell command -v ld.gold),-fuse-ld=gold))
SUPPORT = $(call objects,$(wildcard tests/support/*.c))
# What draws whole inputs by choices: an archive, of which each test links what it uses.
DRAWING = $(BUILD)/libdrawing.a
$(DRAWING): $(call objects,$(filter-out %/replay.c,$(wildcard tests/support/fuzz/*.c)))
	$(Q)rm -f $@; $(AR) rcs $@ $^
define TESTS
TESTS_$(1)_$(2) = $(patsubst %.c,$(BUILD)/%,$(wildcard tests/$(1)/$(2)/*.c tests/$(1)/$(2)/*/*.c))
$$(TESTS_$(1)_$(2)): $(BUILD)/%: $(BUILD)/%.c.o $(SUPPORT) $(DRAWING) $(call archive,$(BELOW_$(2)))
	$(say) LD $$@
	$(Q)$(LINK) $(LINKER) -pie -o $$@ $$^ -lcmocka $(LIBS_$(2)) $(LDLIBS)
$(1)-$(2): $$(TESTS_$(1)_$(2))
	tests/run-tests $$^
.PHONY: $(1)-$(2)
endef
LADDERS = unit faults fuzz validation system bench
$(foreach ladder,$(LADDERS),$(foreach layer,$(LAYERS),$(eval $(call TESTS,$(ladder),$(layer)))))
# The layers with long programs come first, so that no processor waits for one in the end.
all_tests = $(foreach layer,jobs worker core schema server,$(TESTS_$(1)_$(layer)))

test: deps
	@$(MAKE) --no-print-directory -j$$(nproc) run-tests-built
.PHONY: run-tests-built browser
# All ladders but validation, which takes as long as these together. The long ones come first, too.
EVERY_TEST = $(foreach ladder,faults system unit fuzz,$(call all_tests,$(ladder))) $(BUILD)/tests/system/faults/kills
# The page is tried beside them, as a browser mostly waits; what it says follows.
run-tests-built: all $(EVERY_TEST)
	@tests/browser/run $(abspath $(BUILD))/rugo >$(BUILD)/browser.log 2>&1 & browser=$$!; \
	RUGO=$(abspath $(BUILD))/rugo tests/run-tests $(EVERY_TEST); tests=$$?; \
	wait $$browser; page=$$?; cat $(BUILD)/browser.log; [ $$tests -eq 0 ] && [ $$page -eq 0 ]
browser: all
	@tests/browser/run $(abspath $(BUILD))/rugo
unit validation system: all
	@$(MAKE) --no-print-directory -j$$(nproc) $(call all_tests,$@)
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

# Faults of whole processes: programs of their own support, each for RUGO_SECONDS. `make test` runs kills alone, for seconds.
WORLD   = $(call objects,$(wildcard tests/support/faults/*.c))
TESTS_system_faults := $(patsubst %.c,$(BUILD)/%,$(wildcard tests/system/faults/*.c))
$(TESTS_system_faults): $(BUILD)/%: $(BUILD)/%.c.o $(WORLD) $(SUPPORT) $(call archive,$(BELOW_server))
	$(say) LD $@
	$(Q)$(LINK) $(LINKER) -pie -o $@ $^ -lcmocka $(LIBS_server) $(LDLIBS)
SHIM = $(BUILD)/tests/system/faults/failing_writes.so
$(TESTS_system_faults): | $(SHIM)
$(SHIM): $(BUILD)/tests/support/failing/failing_writes.c.o
	@mkdir -p $(@D)
	$(Q)$(LINK) -shared -o $@ $^

fault-deps: deps
	-@tests/install-deps "" "faketime iproute2" faketime ip
faults: all fault-deps
	@$(MAKE) --no-print-directory $(call all_tests,faults) $(TESTS_system_faults)
	@RUGO=$(abspath $(BUILD))/rugo RUGO_SECONDS=$${RUGO_SECONDS:-20} \
	    tests/run-tests $(TESTS_system_faults) $(call all_tests,faults)

# Faults and fuzzing for HOURS, with new seeds; the report and what failed stay in $(BUILD)/soak.
HOURS = 1
soak: all fault-deps fuzz-deps
	@$(MAKE) --no-print-directory -j$$(nproc) $(TESTS_system_faults)
	@RUGO=$(abspath $(BUILD))/rugo MAKE="$(MAKE)" tests/system/faults/soak $(HOURS) \
	    $(BUILD)/soak $(TESTS_system_faults)
# A day of it, for each week: on two processors six hours of faults and 24 hours of CPU of fuzzing.
endurance:
	@FUZZ=255 $(MAKE) --no-print-directory soak HOURS=18
.PHONY: fault-deps soak endurance

# Fuzzing: a target of tests/fuzz/<layer> is a test that replays its corpus (tests/support/fuzz), and with clang's
# libFuzzer in a build of its own it runs for SECONDS, beginning with its corpus. What it finds stays in $(BUILD)-fuzz.
SECONDS = 60
REPLAY  = $(BUILD)/tests/support/fuzz/replay.c.o
$(call all_tests,fuzz): $(REPLAY)
fuzz: fuzz-deps
	@$(MAKE) --no-print-directory -j$$(nproc) BUILD=$(BUILD)-fuzz CC=clang SAN=address,undefined,fuzzer-no-link run-fuzz
fuzz-deps: deps
	@tests/install-deps "" "clang libclang-rt-dev lld" clang ld.lld
# Its threads are at work while libFuzzer looks for leaks after an input; those at the end are found.
FUZZ_FLAGS_requests = -detect_leaks=0
define FUZZ_TARGET
$(BUILD)/fuzz/$(notdir $(1)): $(1).c.o $(DRAWING) $(call archive,$(BELOW_server))
	@mkdir -p $$(@D)
	$(say) LD $$@
	$(Q)$(LINK) -fsanitize=fuzzer -pie -o $$@ $$^ $(LIBS_server) $(LDLIBS)
run-fuzz-$(notdir $(1)): $(BUILD)/fuzz/$(notdir $(1))
	@mkdir -p $$<.corpus
	@cd $$(<D) && ./$$(<F) -max_total_time=$(SECONDS) -timeout=60 -rss_limit_mb=4096 -max_len=8192 -close_fd_mask=2 \
	    -verbosity=0 -print_final_stats=1 $(FUZZ_FLAGS_$(notdir $(1))) $$(<F).corpus $(abspath tests/fuzz/corpus)/$$(<F) >$$(<F).log 2>&1 || \
	    { tail -n 60 $$(<F).log; exit 1; }
	@sed -n 's/^stat::number_of_executed_units: */fuzz $$(<F): executions /p' $$<.log
.PHONY: run-fuzz-$(notdir $(1))
endef
$(foreach target,$(call all_tests,fuzz),$(eval $(call FUZZ_TARGET,$(target))))
# WITHOUT="a b": but for these targets.
run-fuzz: $(patsubst %,run-fuzz-%,$(filter-out $(WITHOUT),$(notdir $(call all_tests,fuzz))))
.PHONY: fuzz fuzz-deps run-fuzz

# Under sanitizers: all unit tests, or (for SAN=thread) those of the layers that own threads, and system tests but those
# that count what is lost or reported within seconds, or memory, which the sanitizer takes. Left out as well are those
# without a second thread (map_commands), and those whose study or store alone is special, while its threads do what they
# do in test_workers and test_publishing. WITHOUT="a b": but for test_a and test_b.
UNTIMED := $(filter-out $(addprefix %/test_,same_answer slurm supervised target commands contact_shown python memory \
	map_commands own_heights third_kind like names folders),$(TESTS_system_server))
UNIT     = $(filter-out $(addprefix %/test_,$(WITHOUT)),$(call all_tests,unit))
THREADED = $(filter-out $(addprefix %/test_,$(WITHOUT)), \
	$(TESTS_unit_worker) $(filter %/test_team,$(TESTS_unit_core)) $(UNTIMED))
run-unit:
	@$(MAKE) --no-print-directory -j$$(nproc) $(UNIT)
	@tests/run-tests $(UNIT)
run-threads:
	@$(MAKE) --no-print-directory -j$$(nproc) all $(THREADED)
	@TSAN_OPTIONS=suppressions=$(abspath tests/thread-sanitizer.txt) \
		RUGO=$(abspath $(BUILD))/rugo tests/run-tests $(THREADED)
.PHONY: run-unit run-threads

# All that .ci/run leaves out, or tries only where its paths changed: some four hours on two processors, a good half of
# them check-book and what has RUGO_EFFORT.
nightly: all
	-@tests/install-deps "" calculix-ccx ccx
	$(MAKE) test
	$(MAKE) lint
	RUGO_EFFORT=4 LIMIT=2400 $(MAKE) unit validation
	RUGO_EFFORT=4 LIMIT=2400 $(MAKE) faults
	$(MAKE) check-documents check-install check-python check-units check-openapi check-contract check-figures check-results tour
	$(MAKE) check-book
	-@tests/install-deps "" "slurmctld slurmd slurm-client munge sqlite3" munged slurmctld slurmd sbatch sqlite3
	$(MAKE) slurm-test
	$(MAKE) roll-test
	$(MAKE) check-static check-dist check-deb
	RUGO_CLEAN_TEST=test $(MAKE) check-clean
	$(MAKE) BUILD=$(BUILD)-O2 CFLAGS=-O2 run-unit
	-@tests/install-deps "" clang clang
	! command -v clang >/dev/null || $(MAKE) BUILD=$(BUILD)-clang CC=clang CFLAGS=-O2 run-unit
	$(MAKE) BUILD=$(BUILD)-address SAN=address,undefined run-unit
	RUGO_EFFORT=4 $(MAKE) BUILD=$(BUILD)-address SAN=address,undefined run-faults
	$(MAKE) BUILD=$(BUILD)-thread SAN=thread run-threads
	$(MAKE) fuzz SECONDS=$(SECONDS)
.PHONY: nightly

deps:
	@CC="$(CC) $(CPPFLAGS)" tests/install-deps "$(PACKAGES)" "$(APT)" $(firstword $(CC)) pkg-config $(HEADERS)

run: deps
	@$(MAKE) --no-print-directory -j$$(nproc) all
	@for study in demo contact-demo; do \
	    $(BUILD)/rugo run --db $(BUILD)/demo.db jobs/studies/$$study.json || exit; echo; done

# Growth alone: of computations by their points, of the store by its studies and cases, of the queue by its jobs. The
# first takes minutes, and is no part of `bench`.
GROWTH      = $(BUILD)/tests/bench/core/bench_computation_growth
GROWTH_ALSO = $(addprefix $(BUILD)/tests/bench/server/,bench_growth bench_queue_growth)
bench: deps
	@$(MAKE) --no-print-directory -j$$(nproc) all $(call all_tests,bench)
	@RUGO=$(abspath $(BUILD))/rugo tests/bench/run $(filter-out $(GROWTH),$(call all_tests,bench))
bench-growth: deps
	@$(MAKE) --no-print-directory -j$$(nproc) all $(GROWTH) $(GROWTH_ALSO)
	@RUGO=$(abspath $(BUILD))/rugo tests/bench/run --alone $(GROWTH) $(GROWTH_ALSO)
.PHONY: bench-growth

# Beside codes of others from PyPI, in a virtual environment of its own; minutes, and part of no other target.
PEERS = numpy scipy tamaas contactmechanics surfacetopography surfalize
PEER_SIDES = 256 512
bench-peers: all
	@python3 -m venv $(BUILD)/peers >$(BUILD)/peers.log 2>&1 || { tests/install-deps "" python3-venv python3-venv && \
	    python3 -m venv $(BUILD)/peers; }
	@for package in $(PEERS); do \
	    $(BUILD)/peers/bin/python -m pip --disable-pip-version-check install --quiet $$package >>$(BUILD)/peers.log 2>&1 || \
	        echo "bench-peers: $$package is not available: $$(tail -n 1 $(BUILD)/peers.log)"; done
	@$(BUILD)/peers/bin/python tests/bench/peers.py $(abspath $(BUILD))/rugo $(BUILD)/peers/maps $(PEER_SIDES)
.PHONY: bench-peers

SOURCES = $(shell git ls-files --cached --others --exclude-standard '*.c' '*.h')
format:
	@clang-format -i $(SOURCES)
check-format:
	@clang-format --dry-run --Werror $(SOURCES)
# Not the programs that made fixtures: they need headers of others. SINCE=REV: those alone that changed since a commit.
CHANGED = $(if $(SINCE),$(shell git diff --name-only $(SINCE) -- '*.c'),%)
LINTED = $(filter-out tests/fixtures/%,$(filter $(CHANGED),$(filter %.c,$(SOURCES))))
lint: lint-deps check-format check-layers check-circles check-citations check-words
	@printf '%s\n' $(LINTED) | \
	    xargs -P $$(nproc) -I {} bash -o pipefail -c \
	        "clang-tidy --quiet {} -- $(LANGUAGE) -Icore 2>&1 | sed '/^[0-9]* warnings* generated/d'"
	@echo "lint: $(words $(LINTED)) files clean"
lint-deps: deps
	@tests/install-deps "" "clang-format clang-tidy" clang-format clang-tidy
.PHONY: lint-deps

# What comments and documents cite is there, and the check of it notices what is not.
check-citations:
	@tests/check-citations --self-test
	@tests/check-citations
	@echo "citations: all found"

# Sentences of documents are short, and words that were given up stay away; the check notices both.
check-words:
	@tests/check-words --self-test
	@tests/check-words
.PHONY: check-words

# The commands of the pages for users, from top to bottom, and what they print; a minute on two processors.
DOCUMENTS = README.md server/command/COMMANDS.md jobs/contact/METHODS.md jobs/studies/measured/README.md \
	jobs/studies/REFERENCE.md
check-documents: all
	@tests/install-deps "" "curl jq sqlite3 librsvg2-bin" curl jq sqlite3 rsvg-convert
	@tests/run-document --self-test
	@tests/run-document $(abspath $(BUILD)/rugo) $(DOCUMENTS)
.PHONY: check-documents

# The pictures of the documents, drawn by the program; CI checks that they are what it draws today.
FIGURES = jobs/studies/figures
# Pages with tables of growth; growth.svg beside a page is drawn from them.
GROWING = schema/README.md jobs/studies/GROWTH.md
# The page with the table of other codes at equal error, of which equal-error.svg is drawn.
PEERS_PAGE = jobs/studies/VALIDATION.md
figures: all
	@$(FIGURES)/draw $(BUILD)/rugo $(FIGURES)
	@tests/install-deps "" python3 python3
	@for page in $(GROWING); do python3 tests/bench/growth_picture.py $$page >$$(dirname $$page)/growth.svg || exit; done
	@python3 tests/bench/error_picture.py $(PEERS_PAGE) >jobs/studies/equal-error.svg
page-figures: all
	@tests/browser/run $(abspath $(BUILD))/rugo $(FIGURES)
# The pages of results, filled from studies that run whole: hours. PAGES="steel ..." for some of them; the store is kept.
BOOK = jobs/studies/results
# Those of all studies come last: they read what the others ran.
OF_ALL = cost cases
PAGES = $(filter-out README $(OF_ALL),$(basename $(notdir $(wildcard $(BOOK)/*.md)))) $(OF_ALL)
PART = 10
book: all
	@$(BOOK)/book $(BUILD)/rugo $(BUILD)/book $(PAGES:%=$(BOOK)/%.md)
# The same from studies a PART-th as large, in a store of their own, compared with what stands there.
check-book: all
	@$(BOOK)/book --self-test
	@$(BOOK)/book --part $(PART) $(BUILD)/rugo $(BUILD)/book-$(PART) $(PAGES:%=$(BOOK)/%.md)
.PHONY: book check-book
# Needs sqlite3, as the documents do.
check-results: all
	@tests/install-deps "" sqlite3 sqlite3
	@sed '/^|/!d' $(BOOK)/cases.md >$(BUILD)/cases.list
	@$(BOOK)/list-cases $(BOOK)/*.md | diff $(BUILD)/cases.list - || { echo "cases.md is not what the pages say: make book PAGES=cases"; exit 1; }
	@tests/check-results --self-test
	@tests/check-results $(BUILD)/rugo
.PHONY: check-results
check-figures: all
	@tests/same-figures --self-test
	@$(FIGURES)/draw $(BUILD)/rugo $(BUILD)/figures
	@tests/same-figures $(FIGURES) $(BUILD)/figures
	@tests/install-deps "" python3 python3
	@for page in $(GROWING); do \
	    python3 tests/bench/growth_picture.py $$page | cmp - $$(dirname $$page)/growth.svg || exit; done
	@python3 tests/bench/error_picture.py $(PEERS_PAGE) | cmp - jobs/studies/equal-error.svg
	@echo "figures: as the program draws them"
.PHONY: check-citations figures page-figures check-figures

# Whether the patch of jobs/studies/measured is what its recipe makes.
tour: all
	@jobs/studies/measured/tour $(abspath $(BUILD)/rugo)
.PHONY: tour

# Against a real Slurm of two nodes on this machine, minutes; skipped, with a word, where there is none.
slurm-test: all
	@tests/system/slurm/run $(abspath $(BUILD)/rugo)
.PHONY: slurm-test

# A server and workers exchanged for those of the next version, under load: two more builds, and a minute.
roll-test: all
	@tests/system/roll/run $(abspath $(BUILD)/rugo)
.PHONY: roll-test

# The description of the HTTP service, by a linter from npm; skipped where there is none.
check-openapi: all
	@tests/lint-openapi $(abspath $(BUILD)/rugo)
.PHONY: check-openapi

# Whether the service keeps to that description, by schemathesis from PyPI, half a minute; skipped where there is none.
check-contract: all
	@tests/check-contract $(abspath $(BUILD)/rugo)
.PHONY: check-contract

# Each archive needs nothing but those of the layers below it: linked whole, it leaves no symbol open.
define WHOLE
$(BUILD)/whole-$(1): $(call archive,$(BELOW_$(1)))
	$(Q)echo 'int main(void) { return 0; }' | $(LINK) -o $$@ -x c - -x none \
	    -Wl,--whole-archive $(BUILD)/lib$(1).a -Wl,--no-whole-archive $$^ $(LIBS_$(1)) $(LDLIBS)
endef
$(foreach layer,$(LAYERS),$(eval $(call WHOLE,$(layer))))
check-layers: $(patsubst %,$(BUILD)/whole-%,$(LAYERS))
	@echo "layers: $(LAYERS): each links whole against those below"

# No file includes or calls itself by way of others, and the check of it notices one that does.
check-circles: $(call archive,$(LAYERS))
	@CC="$(CC)" tests/check-circles --self-test
	@tests/check-circles
	@tests/check-circles --symbols $(BUILD) $(foreach layer,$(LAYERS),$(call objects,$(call sources,$(layer))))
.PHONY: check-layers check-circles

INSTALLED = $(bindir)/rugo $(libdir)/$(SHARED) $(libdir)/$(SONAME) $(libdir)/librugo.so $(libdir)/librugo.a \
            $(libdir)/pkgconfig/rugo.pc $(includedir)/rugo.h $(includedir)/rugo_lists.h $(mandir)/man1/rugo.1 $(completion)/rugo \
            $(pythondir)/rugo.py $(PACKAGE:server/python/%=$(pythondir)/%) $(addprefix $(unitdir)/,$(UNITS)) \
            $(sysusersdir)/rugo.conf
UNITS     = rugo.service rugo-work@.service rugo-snapshot.service rugo-snapshot.timer
PACKAGE   = $(wildcard server/python/rugo/*.py) server/python/rugo/py.typed
install: all
	$(INSTALL) -d $(sort $(dir $(addprefix $(DESTDIR),$(INSTALLED))))
	$(INSTALL_PROGRAM) $(BUILD)/rugo $(DESTDIR)$(bindir)/rugo
	$(INSTALL_PROGRAM) -m 644 $(BUILD)/$(SHARED) $(DESTDIR)$(libdir)/$(SHARED)
	ln -sf $(SHARED) $(DESTDIR)$(libdir)/$(SONAME)
	ln -sf $(SONAME) $(DESTDIR)$(libdir)/librugo.so
	$(INSTALL_DATA) $(BUILD)/librugo.a $(DESTDIR)$(libdir)/librugo.a
	$(INSTALL_DATA) $(BUILD)/rugo.pc $(DESTDIR)$(libdir)/pkgconfig/rugo.pc
	$(INSTALL_DATA) core/rugo.h $(DESTDIR)$(includedir)/rugo.h
	$(INSTALL_DATA) core/rugo_lists.h $(DESTDIR)$(includedir)/rugo_lists.h
	$(INSTALL_DATA) $(BUILD)/rugo.1 $(DESTDIR)$(mandir)/man1/rugo.1
	$(INSTALL_DATA) $(BUILD)/rugo.bash $(DESTDIR)$(completion)/rugo
	$(INSTALL_DATA) server/python/rugo/client.py $(DESTDIR)$(pythondir)/rugo.py
	$(INSTALL_DATA) $(PACKAGE) $(DESTDIR)$(pythondir)/rugo
	for unit in $(UNITS); do \
	    sed 's|/usr/local/bin|$(bindir)|' server/systemd/$$unit >$(BUILD)/$$unit && \
	    $(INSTALL_DATA) $(BUILD)/$$unit $(DESTDIR)$(unitdir)/$$unit || exit; done
	$(INSTALL_DATA) server/systemd/rugo.conf $(DESTDIR)$(sysusersdir)/rugo.conf
uninstall:
	rm -f $(addprefix $(DESTDIR),$(INSTALLED))
	rm -rf $(DESTDIR)$(pythondir)/rugo/__pycache__

# The last commit as an archive, of the same bytes each time, and the packages of Debian that are made from it.
DIST = $(abspath $(BUILD))/dist
dist:
	@mkdir -p $(DIST)
	@[ -z "$$(git status --porcelain)" ] || echo "dist: what is not committed is left out" >&2
	@git -c tar.umask=0022 archive --format=tar --prefix=rugo-$(VERSION)/ -o $(DIST)/rugo-$(VERSION).tar HEAD
	@gzip -9nf $(DIST)/rugo-$(VERSION).tar
	@cd $(DIST) && sha256sum rugo-$(VERSION).tar.gz >SHA256SUMS && cat SHA256SUMS
deb: deps deb-deps dist
	@server/debian/build $(DIST)/rugo-$(VERSION).tar.gz $(BUILD)/deb && ls $(BUILD)/deb/*.deb
deb-deps:
	@tests/install-deps "" "debhelper dh-python" dh dh_python3
# Those two held to their promise; the second in a clean system, as are the README's commands and the Containerfile's
# steps in the third. Skipped, with a word, where no clean system is to be had.
check-dist: deps dist
	@MAKE="$(MAKE) --no-print-directory" tests/check-dist $(DIST)/rugo-$(VERSION).tar.gz
check-deb: deb
	@tests/check-deb $(BUILD)/deb $(VERSION)+$(COMMITTED)
check-clean:
	@tests/check-clean run
	@tests/check-clean image
COMMITTED = $(shell git rev-parse --short=12 HEAD)
.PHONY: dist deb deb-deps check-dist check-deb check-clean

# Into a prefix of its own: header, libraries and pkg-config agree, and the example runs with each library.
check-install: all
	@CC="$(CC)" MAKE="$(MAKE) --no-print-directory BUILD=$(BUILD)" tests/check-install core/example.c
# The package for Python in a virtual environment, with NumPy and pandas from PyPI; skipped, with a word, without these.
check-python: all $(BUILD)/tests/system/server/test_python
	@tests/check-python $(abspath $(BUILD)) $(BUILD)/tests/system/server/test_python
.PHONY: check-python
# The units of systemd, by its own tools, and the server's tried by kills; skipped where there are none.
check-units: all
	@tests/check-units $(abspath $(BUILD))/rugo
	@tests/system/systemd/run $(abspath $(BUILD))/rugo
.PHONY: uninstall check-install check-units
clean:
	rm -rf $(BUILD) $(dir $(wildcard build*/flags))

-include $(shell find $(BUILD) -name '*.d' 2>/dev/null)
