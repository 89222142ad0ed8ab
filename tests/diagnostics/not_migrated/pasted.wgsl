const light_#{INDEX}: f32 = 1.0;
