-- Checksums of what is stored (store_seal.h). NULL: what an older program stored has none.
ALTER TABLE study_case ADD COLUMN seal INTEGER;       -- of what its realisations are computed from
ALTER TABLE result ADD COLUMN seal INTEGER;           -- of the block: which realisations, names, scalars, data
ALTER TABLE published ADD COLUMN curves_seal INTEGER; -- of which curves there are
ALTER TABLE published ADD COLUMN rows_seal INTEGER;   -- of the rows that the views show
ALTER TABLE published ADD COLUMN seal INTEGER;        -- of the document, the report and curves_seal
