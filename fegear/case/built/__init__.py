"""The objects of the mechanics that a case describes: solved gears, loaded pairs, trains, with its effects."""
