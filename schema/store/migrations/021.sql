-- The realisations of each case that were first asked for, by which a key knows its study after an extension; 0 with a
-- target. NULL: not known, as an older program queued the study.
ALTER TABLE study ADD COLUMN asked INTEGER;
-- Over the document of a study: seal_of(source). NULL: an older program queued the study.
ALTER TABLE study_source ADD COLUMN seal INTEGER;
