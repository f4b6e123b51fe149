"""Tables of text cells, from texts and spreadsheets alike: separator, header, units, numbers, times of day."""
