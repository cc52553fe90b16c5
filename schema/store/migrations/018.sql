-- Large blocks, curves and reports are packed by zlib (schema/result/packed_bytes.h), which older programs cannot read.
-- What they stored stays as it is, and is read as it is. Curves of a quantity share the bytes in the row of the first;
-- data of the others is NULL. A packed report is a BLOB.

-- Whether a published case has curves, and no value on any of them.
ALTER TABLE published ADD COLUMN valueless INTEGER NOT NULL DEFAULT 0;
UPDATE published SET valueless = 1
    WHERE EXISTS (SELECT 1 FROM curve c WHERE c.study_id = published.study_id AND c.case_number = published.case_number)
      AND NOT EXISTS (SELECT 1 FROM curve c JOIN point t ON t.curve_id = c.id WHERE c.study_id = published.study_id
                      AND c.case_number = published.case_number AND t.y IS NOT NULL);
CREATE INDEX published_valueless ON published(study_id, case_number) WHERE valueless;
