-- Results belong to what was computed. Studies of the same digest and edition are the same but for
-- their names and numbers of realisations: one may take the blocks of another. NULL: of an older
-- program, or of a study that asks for an error.
ALTER TABLE study ADD COLUMN digest INTEGER;  -- of the parameters of its cases
ALTER TABLE study ADD COLUMN edition INTEGER; -- of the results of the program that it was given to
CREATE INDEX study_digest ON study(digest) WHERE digest IS NOT NULL;
-- study_case.result_bytes is told of every case from here on; NULL: of an older program.
-- Studies that were deleted. Until it is purged, one has rows under another name that nobody finds.
CREATE TABLE deleted_study (
    id INTEGER PRIMARY KEY,               -- of study
    public TEXT NOT NULL UNIQUE,          -- what people called it
    deleted TEXT NOT NULL,
    purged INTEGER NOT NULL DEFAULT 0
);
CREATE INDEX study_purge ON deleted_study(id) WHERE purged = 0;
